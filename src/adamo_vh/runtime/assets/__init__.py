"""Procedural household objects, furniture and the human, each from one builder."""
