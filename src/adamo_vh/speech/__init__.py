"""Ears and a voice: speech to text and back, behind two small protocols."""
