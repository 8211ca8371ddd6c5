"""Gehring 2017: Quadrupedal Locomotion using Trajectory Optimization and Hierarchical Whole Body Control."""
