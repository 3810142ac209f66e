"""The command line: parses, builds, calls; no logic."""

from __future__ import annotations

import sys

from adamo_vh.errors import AdamoError


def main() -> None:
    """Entry point of `adamo-vh`: errors on purpose become one line, not a traceback."""
    from adamo_vh.cli.app import app

    try:
        app()
    except AdamoError as error:
        print(f"adamo-vh: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("adamo-vh: stopped; what happened so far is in the run folder", file=sys.stderr)
        sys.exit(130)
