"""A motion plan: curves and footholds in the plan frame that can be evaluated at any time."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from quadlab.gaits.schedule import BoolArray, ContactSchedule
from quadlab.geometry.curve import Curve
from quadlab.geometry.pose_curve import PoseCurve, pose_curve
from quadlab.geometry.rotations import Array


class PlanSample(NamedTuple):
    """A plan at one time; everything in the plan frame P.

    Attributes:
        com_position, com_velocity, com_acceleration: (3,) in [m], [m/s], [m/s^2].
        yaw, yaw_rate: heading of the base in [rad], [rad/s].
        cop: centre of pressure on the ground, (2,) in [m].
        contacts: (4,) flags.
    """

    com_position: Array
    com_velocity: Array
    com_acceleration: Array
    yaw: float
    yaw_rate: float
    cop: Array
    contacts: BoolArray


@dataclass(frozen=True)
class PlanVerdict:
    """What the independent checker found on its dense grid.

    Attributes:
        values: worst violation by name, in the unit that the name carries.
        tolerances: the tolerance each of them was compared with.
    """

    values: dict[str, float]
    tolerances: dict[str, float]

    @property
    def violated(self) -> list[str]:
        """Names whose value is above its tolerance (or not a number)."""
        return [name for name, value in self.values.items() if not value <= self.tolerances[name]]

    @property
    def accepted(self) -> bool:
        """Whether nothing is violated."""
        return not self.violated

    @property
    def complaint(self) -> str:
        """What is violated, each with value and tolerance."""
        return ", ".join(f"{name} {self.values[name]:.3g} > {self.tolerances[name]:.3g}" for name in self.violated)


UNCHECKED = PlanVerdict({}, {})
"""The verdict of a plan on its way to the checker."""


@dataclass(frozen=True)
class PlanReport:
    """How a plan came about.

    Attributes:
        planner: kind of the planner.
        build_ms, solve_ms: wall time of building and of solving in [ms].
        iterations: solver iterations.
        variables, constraints: size of the nonlinear program.
        costs: final cost by name.
        residuals: worst violation of each named constraint set, in its own unit, as the transcription sees it.
        cost_history: cost by name of the first guess and after every iteration; empty if the solver does not tell.
    """

    planner: str
    build_ms: float
    solve_ms: float
    iterations: int
    variables: int
    constraints: int
    costs: dict[str, float] = field(default_factory=dict)
    residuals: dict[str, float] = field(default_factory=dict)
    cost_history: list[dict[str, float]] = field(default_factory=list)


@dataclass(frozen=True)
class BaseMotion:
    """The base at the samples of a plan, for planners that plan it.

    Attributes:
        times_s: (n,) increasing in [s].
        positions: base origin in the plan frame, (n, 3) in [m].
        quats_wxyz: base to plan frame, (n, 4).
    """

    times_s: Array
    positions: Array
    quats_wxyz: Array


@dataclass(frozen=True)
class MotionPlan:
    """What a planner hands to a controller.

    Attributes:
        schedule: contact flags of the plan.
        com: centre of mass over time, d = 3, in [m].
        heading: yaw of the base over time, d = 1, in [rad].
        cop: centre of pressure over time, d = 2, in [m].
        footholds: per leg (swings + 1, 3) in [m]: where it starts, then where each swing ends.
        report: how it was made.
        verdict: what the checker says about it.
        foot_yaws: per foot (swings + 1,) yaw of the foot in each stance in [rad]; empty for point feet.
        base: pose of the base at samples, for planners that plan it; None for a point mass.
    """

    schedule: ContactSchedule
    com: Curve
    heading: Curve
    cop: Curve
    footholds: tuple[Array, ...]
    report: PlanReport
    verdict: PlanVerdict
    foot_yaws: tuple[Array, ...] = ()
    base: BaseMotion | None = None

    @cached_property
    def base_curve(self) -> PoseCurve | None:
        """The motion of the base through its samples (Gehring 2017, III-C); None for a point mass."""
        return None if self.base is None else pose_curve(self.base.times_s, self.base.positions, self.base.quats_wxyz)

    @property
    def duration_s(self) -> float:
        """Length of the plan in [s]."""
        return self.schedule.duration_s

    def foothold_at(self, leg: int, time_s: float) -> Array:
        """Return where ``leg`` stands at ``time_s`` in [s], or stood before the swing under way, (3,) in [m]."""
        foothold: Array = self.footholds[leg][self.schedule.swing_at(leg, time_s)[0]]
        return foothold

    def at(self, time_s: float) -> PlanSample:
        """Return the plan at ``time_s`` in [s]; after its end it stands still."""
        position, velocity, acceleration = self.com.motion(time_s)
        heading = self.heading.motion(time_s)
        return PlanSample(
            com_position=position,
            com_velocity=velocity,
            com_acceleration=acceleration,
            yaw=float(heading[0, 0]),
            yaw_rate=float(heading[1, 0]),
            cop=self.cop.motion(time_s)[0],
            contacts=self.schedule.contacts_at(time_s),
        )
