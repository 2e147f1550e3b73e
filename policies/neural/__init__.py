"""Neural policies: the policy, decoding, rollouts, sharing, and weights on disk."""
