"""Campaigns: many cases, headless, with one row a case in a store."""
