"""Studies that train networks: runs in processes of their own, held-out scenarios, differences with intervals."""
