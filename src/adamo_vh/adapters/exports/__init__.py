"""Recorded episodes in the forms of other tools; nothing is played again, no engine is needed."""
