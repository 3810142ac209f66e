"""The paper's own figures: what it prints, and its authors' published data, cell by cell."""
