"""Whether a scene or an engine is sound, and what is wrong if not."""
