"""Sparse quadratic programs: one interface, several solvers."""
