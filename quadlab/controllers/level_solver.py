"""The solver behind controllers with levels: which method, and whether its answer is proved in every tick."""

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal, NamedTuple

import qpsolvers
from pydantic import Field, field_validator

from quadlab.controllers.controller_config import TrackingControllerConfig
from quadlab.controllers.formulation import FORMULATIONS, FormulationName, constraint_names
from quadlab.controllers.hierarchy import StackedLevels, certificate, solve_stacked, unstack
from quadlab.controllers.hierarchy.cascade import CascadeStatus, QpSolver, solve_cascade
from quadlab.controllers.task_levels import LevelConfig, check_level_names
from quadlab.geometry.rotations import Array

WEIGHTED = "weighted"
"""Name of the level that holds all tasks of a weighted controller."""
_ITERATION_LIMIT = 500
_REASONS = (
    "a row of the levels has a number that is not finite",
    f"more than {_ITERATION_LIMIT} iterations of the active set",
    "numerical breakdown",
)
"""Why there is no answer, by the status of ``StackedResult``."""
_FORCE_LIMITS = ("torque_limits", "friction_cone")
"""Tasks that limit torques and contact forces; friction gives way to torque limits above it, and to nothing else."""


def _is_force_limit(task: Any) -> bool:
    return task.task in _FORCE_LIMITS


class LevelledControllerConfig(TrackingControllerConfig):
    """Tasks in levels and how they are solved.

    Attributes:
        levels: highest priority first; names are unique.
        formulation: decision variables; all have the same solutions, and the reduced ones are solved fastest.
        method: lexicographic: one active-set method for all levels; cascade: one quadratic program a level, as printed
            in Bellicoso 2016, Eq. (9)-(12). A tick in which one of its programs fails counts as not solved.
        qp_solver: back end of the cascade; has to be installed.
        certify: whether each tick is proved optimal (see ``certificate``); it costs about as much as the tick itself.
    """

    levels: Annotated[tuple[LevelConfig, ...], Field(min_length=1)]
    formulation: FormulationName
    method: Literal["lexicographic", "cascade"]
    qp_solver: QpSolver
    certify: bool

    @property
    def limit_names(self) -> tuple[str, ...]:
        """Names of the levels that hold nothing but limits of torques and contact forces."""
        return tuple(level.name for level in self.levels if all(_is_force_limit(task) for task in level.tasks))

    @field_validator("levels")
    @classmethod
    def _unique_names(cls, levels: tuple[LevelConfig, ...]) -> tuple[LevelConfig, ...]:
        taken = {name for formulation in FORMULATIONS for name in constraint_names(formulation)} | {WEIGHTED}
        reserved = sorted(taken & {level.name for level in levels})
        if reserved:
            raise ValueError(f"level names {', '.join(reserved)} are those of the controller's own levels; use others")
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
        reason: why the method did not finish; empty if it did.
    """

    x: Array
    residuals: dict[str, float]
    iterations: int
    solved: bool
    certificate: float = math.nan
    reason: str = ""


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
        residuals = dict(zip(self.names, norms, strict=True))
        if result.status == 0 and not math.isnan(sum(norms)):
            return LevelSolution(result.x, residuals, result.iterations, solved=True)
        reason = _REASONS[result.status]
        return LevelSolution(result.x, residuals, result.iterations, solved=False, reason=reason)

    def _cascade(self, levels: StackedLevels, start: Array) -> LevelSolution:
        solution = solve_cascade(unstack(levels, self.names), start, qp_solver=self.config.qp_solver)
        solved = solution.status is CascadeStatus.SOLVED
        reason = "; ".join(f"level {name}: {text}" for name, text in solution.failures.items())
        return LevelSolution(solution.x, solution.residual_norms, solution.programs, solved, reason=reason)
