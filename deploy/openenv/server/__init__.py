"""The server of the container."""
