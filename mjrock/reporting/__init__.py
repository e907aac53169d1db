"""Reports: one page about a case and its responses, for the file of a building."""
