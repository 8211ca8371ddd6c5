"""What a transcription answers, whichever solver it uses."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan, PlanReport
from quadlab.planners.problem import PlanningProblem


@dataclass(frozen=True)
class Solution:
    """Where a solver stopped.

    Attributes:
        x: last iterate.
        status: the solver's name and its own word for how it ended.
        converged: whether the solver says that it found an optimum.
        infeasible: whether the solver says that its last iterate is a local least violation of the constraints.
        iterations: how many it took.
        solve_ms: wall time in [ms].
        costs: weighted costs by name.
        residuals: worst violation of each constraint set, in the unit that its name carries.
        cost_history: weighted costs by name of the first guess and after every iteration, over all attempts.
    """

    x: Array
    status: str
    converged: bool
    infeasible: bool
    iterations: int
    solve_ms: float
    costs: Mapping[str, float]
    residuals: Mapping[str, float]
    cost_history: tuple[Mapping[str, float], ...]


def worst_violation(violations: Array) -> float:
    """Return the largest violation, at least 0; NaN if there is one."""
    return float(np.maximum(violations, 0.0).max(initial=0.0))


class Build(Protocol):
    """A problem that has been transcribed and can be solved, any number of times."""

    @property
    def problem(self) -> PlanningProblem:
        """The problem in words."""
        ...

    @property
    def build_ms(self) -> float:
        """Wall time of the transcription in [ms]."""
        ...

    @property
    def size(self) -> tuple[int, int]:
        """Number of variables and of constraints."""
        ...

    def solve(self) -> Solution:
        """Solve from the first iterate of the transcription."""
        ...

    def motion_plan(self, x: Array, report: PlanReport) -> MotionPlan:
        """Return the plan of the iterate ``x``; its verdict is empty until it has been checked."""
        ...
