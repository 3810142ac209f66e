"""Faces for other worlds: videos, exports."""
