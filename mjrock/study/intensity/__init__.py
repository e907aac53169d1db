"""Intensities that overturn a wall, under one record or many."""
