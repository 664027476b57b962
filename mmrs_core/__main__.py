"""Runs the command line: ``python -m mmrs_core``."""

from mmrs_core.cli import main

if __name__ == "__main__":
    main()
