"""A built-in model served over HTTP, with faults on demand."""
