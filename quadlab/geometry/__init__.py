"""Rotations, splines and polygons."""
