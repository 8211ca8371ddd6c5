"""The solver behind controllers with levels: which method, and whether its answer is proved in every tick."""

import math
from collections.abc import Sequence
from typing import Annotated, Literal, NamedTuple

import qpsolvers
from pydantic import Field, field_validator

from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.formulation import FormulationName
from quadlab.controllers.hierarchy import StackedLevels, certificate, solve_stacked, unstack
from quadlab.controllers.hierarchy.cascade import CascadeStatus, QpSolver, solve_cascade
from quadlab.controllers.task_levels import LevelConfig, check_level_names
from quadlab.geometry.rotations import Array

_ITERATION_LIMIT = 500


class LevelledControllerConfig(TrackingControllerConfig):
    """Tasks in levels and how they are solved.

    Attributes:
        levels: highest priority first; names are unique.
        formulation: decision variables; all have the same solutions, and the reduced ones are solved fastest.
        method: lexicographic: one active-set method for all levels; cascade: one quadratic program a level, as printed
            in Bellicoso 2016, Eq. (9)-(12).
        qp_solver: back end of the cascade; has to be installed.
        certify: whether each tick is proved optimal (see ``certificate``); it costs about as much as the tick itself.
    """

    levels: Annotated[tuple[LevelConfig, ...], Field(min_length=1)]
    formulation: FormulationName
    method: Literal["lexicographic", "cascade"]
    qp_solver: QpSolver
    certify: bool

    @field_validator("levels")
    @classmethod
    def _unique_names(cls, levels: tuple[LevelConfig, ...]) -> tuple[LevelConfig, ...]:
        return check_level_names(levels)

    @field_validator("qp_solver")
    @classmethod
    def _installed(cls, qp_solver: QpSolver) -> QpSolver:
        if qp_solver not in qpsolvers.available_solvers:
            raise ValueError(f"{qp_solver} is not installed; installed: {', '.join(qpsolvers.available_solvers)}")
        return qp_solver


class LevelSolution(NamedTuple):
    """What a method found.

    Attributes:
        x: (n,) decision variables.
        residuals: norm of the slacks of each level, by name.
        iterations: of the active set, or quadratic programs of the cascade.
        solved: whether the method finished.
        certificate: largest remainder of the optimality conditions over the levels; NaN if not asked for.
    """

    x: Array
    residuals: dict[str, float]
    iterations: int
    solved: bool
    certificate: float = math.nan


class LevelSolver:
    """Solves stacked levels by the configured method."""

    def __init__(self, config: LevelledControllerConfig, names: Sequence[str]) -> None:
        self.config = config
        self.names = tuple(names)

    def solve(self, levels: StackedLevels, start: Array) -> LevelSolution:
        """Return the solution of ``levels`` closest to ``start``, (n,)."""
        lexicographic = self.config.method == "lexicographic"
        solution = self._lexicographic(levels, start) if lexicographic else self._cascade(levels, start)
        if not self.config.certify:
            return solution
        remainders = certificate(unstack(levels, self.names), solution.x)
        return solution._replace(certificate=float(remainders.max()))

    def _lexicographic(self, levels: StackedLevels, start: Array) -> LevelSolution:
        result = solve_stacked(*levels, start, _ITERATION_LIMIT)
        norms = result.norms.tolist()
        solved = result.status == 0 and not math.isnan(sum(norms))
        return LevelSolution(result.x, dict(zip(self.names, norms, strict=True)), result.iterations, solved)

    def _cascade(self, levels: StackedLevels, start: Array) -> LevelSolution:
        solution = solve_cascade(unstack(levels, self.names), start, qp_solver=self.config.qp_solver)
        solved = solution.status is CascadeStatus.SOLVED
        return LevelSolution(solution.x, solution.residual_norms, solution.programs, solved)
