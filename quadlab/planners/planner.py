"""The planner interface: building and solving are separate, and no plan leaves unchecked."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol

from quadlab.errors import PlanningProblemError
from quadlab.planners.plan import MotionPlan
from quadlab.planners.problem import PlanningProblem


class PlanningStatus(StrEnum):
    """How planning ended."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    SOLVER_LIMIT = "solver_limit"
    REJECTED = "rejected_by_checker"


@dataclass(frozen=True)
class PlanningOutcome:
    """The answer of a planner: a checked plan, or why there is none.

    Attributes:
        status: how planning ended.
        reason: one line; names the violated constraint sets when there is no plan.
        plan: present exactly if the status is SOLVED.
    """

    status: PlanningStatus
    reason: str
    plan: MotionPlan | None


class Planner(Protocol):
    """What every planner can do."""

    def prepare(self) -> None:
        """Load whatever takes long once a process, so that ``build`` and ``solve`` are timed without it."""
        ...

    def build(self, problem: PlanningProblem) -> Any:
        """Return the transcription of ``problem``: everything but the solution.

        Raises:
            PlanningProblemError: if the problem is malformed.
        """
        ...

    def solve(self, transcription: Any) -> PlanningOutcome:
        """Solve a transcription, check the plan and return the outcome."""
        ...


def solved(planner: Planner, problem: PlanningProblem) -> PlanningOutcome:
    """Build and solve; a problem that is malformed, which no plan can begin from, has an answer, too."""
    try:
        return planner.solve(planner.build(problem))
    except PlanningProblemError as error:
        return PlanningOutcome(PlanningStatus.INFEASIBLE, str(error), None)
