"""One short file for each reinforcement-learning library: the environment plugged in, and a policy that learns.

Each has ``train(...)``, which returns a policy for the AEC loop, and runs as ``python -m
mrta_zoo.train.integrations.NAME --seed 0``. The libraries come with the extras of the same names, or all with
``pip install "mrta_zoo[integrations]"``.
"""
