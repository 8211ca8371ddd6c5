"""Constraint sets of the ZMP spline planner, one a file."""
