"""Commands for those who write no script."""
