"""The eight motions of Table I of Winkler 2017 as planning problems, with what the paper reports of them."""

from dataclasses import dataclass, replace

import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart, Waypoints
from quadlab.robots.legs import LEGS

HYQ = PlanningModel(
    com_height=0.6,  # [m]
    nominal_feet=np.array([[0.37, 0.27], [0.37, -0.27], [-0.37, 0.27], [-0.37, -0.27]]),  # [m]
    reach=np.array([0.20, 0.15]),  # [m]
)
"""A model of HyQ's size: the paper states the height, stance and reach are values of ours."""

_PHASES: dict[str, tuple[tuple[float, str], ...]] = {
    "walk": ((0.4, "LH"), (0.4, "LF"), (0.4, "RH"), (0.4, "RF")),
    "trot": ((0.3, "RF LH"), (0.3, "LF RH")),
    "pace": ((0.08, ""), (0.24, "LF LH"), (0.16, ""), (0.24, "RF RH"), (0.08, "")),
    "bound": ((0.08, ""), (0.24, "LF RF"), (0.16, ""), (0.24, "LH RH"), (0.08, "")),
}
"""One stride of each gait, four steps: phases of (duration in [s], legs in the air). The paper gives horizons only."""

NODE_PERIODS_S = {"walk": 0.1, "trot": 0.1, "pace": 0.08, "bound": 0.08}
"""Longest time between load nodes of the reduced transcription in [s]."""


@dataclass(frozen=True)
class TableOneCase:
    """One column of Table I.

    Attributes:
        gait: walk, trot, pace or bound.
        steps: footholds of the motion; a swing of two legs makes two.
        distance_m: displacement of the CoM in [m].
        polynomial_s: duration of a CoM polynomial in the paper in [s].
        with_cost: whether the paper minimises J_lambda.
        paper_ipopt_s, paper_snopt_s, paper_variables, paper_constraints: what the paper reports.
    """

    gait: str
    steps: int
    distance_m: float
    polynomial_s: float
    with_cost: bool
    paper_ipopt_s: float
    paper_snopt_s: float
    paper_variables: int
    paper_constraints: int

    @property
    def name(self) -> str:
        """Gait and number of steps."""
        return f"{self.gait} {self.steps}"


TABLE_ONE = (
    TableOneCase("walk", 16, 1.0, 0.1, True, 0.25, 0.35, 646, 850),
    TableOneCase("walk", 4, 0.2, 0.1, True, 0.06, 0.04, 202, 270),
    TableOneCase("trot", 16, 1.0, 0.05, False, 0.02, 0.04, 387, 548),
    TableOneCase("trot", 4, 0.2, 0.05, False, 0.01, 0.01, 162, 255),
    TableOneCase("pace", 16, 1.0, 0.02, False, 0.21, 0.54, 1868, 2331),
    TableOneCase("pace", 4, 0.2, 0.02, False, 0.12, 0.18, 728, 939),
    TableOneCase("bound", 16, 1.0, 0.02, False, 0.17, 0.42, 1868, 2331),
    TableOneCase("bound", 4, 0.2, 0.02, False, 0.04, 0.29, 728, 939),
)


def table_one_phases(gait: str) -> tuple[tuple[float, str], ...]:
    """Return the phases of one stride of a gait of Table I: (duration in [s], legs in the air)."""
    return _PHASES[gait]


def table_one_schedule(gait: str, steps: int) -> ContactSchedule:
    """Return ``steps`` / 4 strides of one of the gaits of Table I."""
    return schedule_of(table_one_phases(gait) * (steps // 4))


def schedule_of(phases: tuple[tuple[float, str], ...]) -> ContactSchedule:
    """Return the schedule of phases (duration in [s], names of the legs in the air, divided by blanks)."""
    contacts = [[leg not in air.split() for leg in LEGS] for _, air in phases]
    durations, flags = np.array([duration for duration, _ in phases]), np.array(contacts)
    new = np.r_[True, (flags[1:] != flags[:-1]).any(axis=1)]
    starts = np.flatnonzero(new)
    return ContactSchedule(np.add.reduceat(durations, starts), flags[starts])


def table_one_problem(case: TableOneCase, seed: int | None = None) -> PlanningProblem:
    """Return a case as in the paper: from standing in the default stance straight forward.

    Args:
        case: column of the table.
        seed: if given, CoM and feet begin up to 1 cm and 2 cm off the default stance, the goal is up to a tenth of the
            distance off, at random: Newton's method solves some of the nominal cases in a single step.
    """
    problem = straight_problem(table_one_schedule(case.gait, case.steps), np.array([case.distance_m, 0.0]))
    return problem if seed is None else _varied(problem, np.random.default_rng(seed))


def _varied(problem: PlanningProblem, random: np.random.Generator) -> PlanningProblem:
    start, path = problem.start, problem.waypoints.poses.copy()
    feet = start.feet.copy()
    feet[:, :2] += random.uniform(-0.02, 0.02, (len(feet), 2))
    path[0, :2] += random.uniform(-0.01, 0.01, 2)
    path[-1, :2] += 0.1 * path[-1, 0] * random.uniform(-1.0, 1.0, 2)
    return replace(
        problem,
        start=replace(start, com_position=path[0, :2].copy(), feet=feet),
        waypoints=Waypoints(problem.waypoints.times_s, path),
    )


def straight_problem(
    schedule: ContactSchedule,
    goal: np.ndarray,
    model: PlanningModel = HYQ,
    velocity: np.ndarray | None = None,
) -> PlanningProblem:
    """Return the problem to go from the nominal stance to ``goal``, without turning.

    Args:
        schedule: contact flags.
        goal: where the CoM comes to rest, (2,) in [m].
        model: robot as the planner sees it.
        velocity: of the CoM at the start, (2,) in [m/s]; at rest if None.
    """
    feet = np.column_stack([model.nominal_feet, np.zeros(len(model.nominal_feet))])
    start = PlanStart(np.zeros(2), np.zeros(2) if velocity is None else velocity, 0.0, feet)
    path = np.array([[0.0, 0.0, 0.0], [goal[0], goal[1], 0.0]])
    return PlanningProblem(start, Waypoints(np.array([0.0, schedule.duration_s]), path), schedule, model)


def table_one_changes(case: TableOneCase, transcription: str) -> dict[str, object]:
    """Return the settings of the vertex-ZMP planner that make a case what it is in the paper.

    J_lambda is the only cost, and the CoM polynomials are those of the paper in its transcription.
    """
    return {
        "transcription": transcription,
        "polynomial_duration_s": case.polynomial_s if transcription == "paper" else NODE_PERIODS_S[case.gait],
        "robustness_weight": 1.0 if case.with_cost else 0.0,
        "com_acceleration_weight": 0.0,
        "nominal_foothold_weight": 0.0,
        "waypoint_weight": 0.0,
    }
