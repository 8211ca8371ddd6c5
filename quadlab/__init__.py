"""Reproducible quadruped locomotion experiments: planning, whole-body control, simulated trials."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("quadlab")
except PackageNotFoundError:  # a source tree that was never installed
    __version__ = "0+unknown"
