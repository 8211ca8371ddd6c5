"""Turns plan and state into joint torques: references, tasks, limits and the solvers that combine them."""
