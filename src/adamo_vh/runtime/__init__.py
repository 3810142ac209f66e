"""The Runtime Engine: the 3D world, its physics, its pictures and the body in it."""
