"""Evaluate: what is asked, how hard it is, and how well it was done."""
