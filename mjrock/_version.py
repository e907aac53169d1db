"""The version, recorded in every generated model. The build reads it from here."""

__version__ = "0.2.0.dev0"
