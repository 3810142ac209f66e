"""One episode as data: how it is set up, what came of it, and its replay."""
