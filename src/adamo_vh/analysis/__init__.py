"""What many episodes say together: outcomes, cells, statistics. Pure functions, no engine."""
