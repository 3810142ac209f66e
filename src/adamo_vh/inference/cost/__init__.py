"""What a model call takes: tokens and money."""
