"""Trained weights that ship with the package, each with its configuration and model card."""
