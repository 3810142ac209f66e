"""What can be wrong with an own figure's file."""

from __future__ import annotations


class Broken(Exception):  # noqa: N818 - it is a finding on its way to a `FileError`
    """The file cannot be used; one line that says why and what helps, without the file's name."""


AGAIN = "Export it again from the program it was made in."
"""What helps against a file that breaks its format."""
