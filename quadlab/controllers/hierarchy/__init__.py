"""Hierarchical (lexicographic) least squares with equalities and inequalities; knows nothing of robots."""

from quadlab.controllers.hierarchy.certificate import certificate
from quadlab.controllers.hierarchy.level import HierarchyError, Level, StackedLevels, stack, unstack
from quadlab.controllers.hierarchy.solver import HierarchySolution, HierarchyStatus, solve_hierarchy
from quadlab.controllers.hierarchy.stacked import solve_stacked

__all__ = [
    "HierarchyError",
    "HierarchySolution",
    "HierarchyStatus",
    "Level",
    "StackedLevels",
    "certificate",
    "solve_hierarchy",
    "solve_stacked",
    "stack",
    "unstack",
]
