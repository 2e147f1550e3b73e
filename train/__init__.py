"""Parameter-shared REINFORCE: configuration, baselines, trainer, checkpoints."""
