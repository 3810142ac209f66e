"""From words to what is meant."""
