"""Reports: tables and figures with the data behind them, as Markdown and HTML."""
