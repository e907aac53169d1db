"""The version, recorded in every generated model. The build reads it from here."""

__version__ = "1.0.0"
