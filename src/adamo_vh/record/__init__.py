"""What happened, as it is written down: events, the run folder, and what they name."""
