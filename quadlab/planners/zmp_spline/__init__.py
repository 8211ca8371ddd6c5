"""ZMP walk planner: CoM splines from one convex quadratic program, footholds fixed beforehand."""
