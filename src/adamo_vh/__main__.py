"""`python -m adamo_vh` is the command line."""

from adamo_vh.cli import main

if __name__ == "__main__":
    main()
