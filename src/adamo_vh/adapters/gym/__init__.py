"""Gymnasium: every scene and task as an environment for reinforcement learning; extra `gym`."""
