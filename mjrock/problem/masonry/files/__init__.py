"""Blocks from files: drawings, meshes and models of COMPAS."""
