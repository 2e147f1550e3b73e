"""Learning from plans, before REINFORCE: expert plans, the decisions behind them, gradient steps."""
