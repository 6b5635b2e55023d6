"""The version, here alone: packaging, provenance and pages read it."""

__version__ = "0.4.0"
