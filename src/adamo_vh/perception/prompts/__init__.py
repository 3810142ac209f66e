"""The form of the text mirror, as a text file."""
