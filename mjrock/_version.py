"""The version, recorded in every generated model."""

from importlib.metadata import version

__version__ = version("mjrock")
