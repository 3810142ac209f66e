"""From what is known to the next turn."""
