"""``python -m mrta_zoo``: the command line."""

from mrta_zoo.cli.main import main

if __name__ == "__main__":
    raise SystemExit(main())
