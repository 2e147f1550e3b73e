"""Puts this folder on the path, so that tests in subfolders can `from strategies import ...`."""

import torch

torch.set_num_threads(1)  # at the tests' sizes more threads only get in each other's way
