"""One wall in other codes, each as its own documentation would have it; `peers.py` runs and compares them.

A code that is not installed is skipped. Nothing here imports mjrock: what a peer is given is a `Question` of numbers.
"""
