"""Whole-body kinematics and a pendulum in one nonlinear program (Gehring 2017, Section II)."""
