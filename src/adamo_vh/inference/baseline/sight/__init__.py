"""From pixels to what things look like."""
