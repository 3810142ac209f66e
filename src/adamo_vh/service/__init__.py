"""The package as a service: sessions that others use over a wire."""
