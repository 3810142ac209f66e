"""`python -m adamo` is the command line."""

from adamo.cli import main

if __name__ == "__main__":
    main()
