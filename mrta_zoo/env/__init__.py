"""The environment: the mission under way as PettingZoo and Gymnasium see it, with its observations and rewards."""
