"""The report of a study: one page, the same tables for papers and programs, vector figures."""
