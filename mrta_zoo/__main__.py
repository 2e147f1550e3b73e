"""``python -m mrta_zoo``: the command line."""

from mrta_zoo.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
