"""The settings of the vertex-ZMP planner."""

from typing import Annotated, Literal

from pydantic import Field

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.planners.checker import CheckerConfig


class VertexZmpConfig(StrictModel):
    """Settings of the vertex-ZMP planner.

    Attributes:
        name: of the planner in results; several files may be of one kind.
        transcription: ``paper`` is the formulation of Winkler 2017, with additions, in CasADi for Ipopt; ``fast`` is
            the same problem reduced: exact pendulum motion, loads of feet in contact only, own solver; point feet only.
        polynomial_duration_s: longest polynomial T_k of the CoM spline in [s]; for ``fast`` the longest time between
            load nodes.
        robustness_weight: weight of J_lambda, Eq. (21), in [1/s].
        com_acceleration_weight: weight of the squared CoM acceleration over time in [s^3/m^2].
        nominal_foothold_weight: weight of the squared distance of footholds from the nominal stance in [1/m^2].
        foot_yaw_weight: weight of the misalignment of feet that are no points with the heading.
        waypoint_weight: weight of the squared distance of the CoM from intermediate waypoints in [1/m^2].
        reach_margin_m: how much smaller than the reach of the model the enforced box is, to every side, in [m].
        max_iterations: limit of the solver; for ``fast`` over all its attempts together.
        max_wall_time_s: limit of Ipopt in [s]; whether it ends the iteration depends on the machine, and the reason
            says so. ``fast`` does not look at the clock.
        solver_tolerance: convergence tolerance of the solver.
        residual_tolerance: largest residual of any constraint set in its own unit ([m], [m/s] or none).
        checker: tolerances of the independent checker.
    """

    kind: Literal["vertex_zmp"]
    name: str
    transcription: Literal["paper", "fast"]
    polynomial_duration_s: Positive
    robustness_weight: NonNegative
    com_acceleration_weight: NonNegative
    nominal_foothold_weight: NonNegative
    foot_yaw_weight: NonNegative
    waypoint_weight: NonNegative
    reach_margin_m: NonNegative
    max_iterations: Annotated[int, Field(ge=1)]
    max_wall_time_s: Positive
    solver_tolerance: Positive
    residual_tolerance: Positive
    checker: CheckerConfig
