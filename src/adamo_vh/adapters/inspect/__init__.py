"""Inspect AI: our studies as its tasks, and its models as minds of our body.

Needs the extra `inspect`; nothing here is imported before Inspect asks for it.
"""
