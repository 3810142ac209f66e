"""A study: many episodes, planned, played, survived and kept by one command."""
