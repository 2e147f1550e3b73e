"""The command line, ``mrta-zoo``: one file for each command."""
