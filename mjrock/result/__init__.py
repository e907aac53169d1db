"""Results: the response, its peaks and impacts, its energy ledger, and comparisons."""
