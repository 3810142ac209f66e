"""What people read of a run: pages, timeline, floor plan."""
