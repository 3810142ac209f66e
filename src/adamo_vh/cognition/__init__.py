"""The Cognitive Server: prompts, memory, and the loop of perceive, reason, act."""
