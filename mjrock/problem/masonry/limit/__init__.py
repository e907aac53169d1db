"""Limit analysis of rigid masonry: whether it stands, and the push that it bears."""
