"""Cost terms of the ZMP spline planner, one a file."""
