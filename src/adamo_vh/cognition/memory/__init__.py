"""What the mind remembers: the short-term memory and how it is written as a prompt."""
