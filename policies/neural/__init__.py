"""Trained networks: the policy, how it decodes, who shares it, and its files."""
