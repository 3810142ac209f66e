"""Models without a network: scripted, random, recorded."""
