"""Robots that public packages carry: their contacts, their feet, and their contacts in MJX."""
