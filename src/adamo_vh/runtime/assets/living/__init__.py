"""The furniture and decoration of a living room."""
