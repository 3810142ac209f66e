"""The one edge of every server that the package opens."""
