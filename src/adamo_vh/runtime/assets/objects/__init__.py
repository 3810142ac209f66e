"""The household objects: one short builder each, grouped by theme."""
