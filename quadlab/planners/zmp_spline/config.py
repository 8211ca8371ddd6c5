"""The settings of the ZMP spline planner."""

from typing import Annotated, Literal

from pydantic import Field

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.planners.checker import CheckerConfig


class ZmpSplineConfig(StrictModel):
    """Settings of the ZMP spline planner.

    Attributes:
        name: of the planner in results; several files may be of one kind.
        segment_duration_s: longest quintic segment of the CoM in [s]; every phase has one or more.
        sample_period_s: largest distance of the times at which constraints hold in [s].
        support_margin_m: how far inside the support polygon the ZMP stays in [m].
        support_slack_weight: None makes the support a hard constraint. A number allows the ZMP to leave it, at this
            price a squared distance and second, in [1/s^4]: the only way to plan for supports that are lines.
        reach_margin_m: how much smaller than the reach of the model the box of every foot is, in [m]; None leaves the
            legs' range of motion to the controller, as the paper does.
        support_centre_weight: weight of the squared distance of the ZMP from the middle of the support inside its
            margin, or of the whole support if nothing is inside, in [1/s^4].
        waypoint_weight: weight of the squared distance of the CoM from intermediate waypoints in [1/s^3].
        qp_solver: by its name in qpsolvers.
        qp_tolerance: absolute tolerance asked of the solver.
        optimality_tolerance: largest residual of the optimality conditions, relative to the gradient, dimensionless.
        constraint_tolerance_m: largest violation of any constraint set in [m].
        checker: tolerances of the independent checker.
    """

    kind: Literal["zmp_spline"]
    name: str
    segment_duration_s: Positive
    sample_period_s: Positive
    support_margin_m: NonNegative
    support_slack_weight: Positive | None
    reach_margin_m: Annotated[float, Field(ge=0.0)] | None
    support_centre_weight: NonNegative
    waypoint_weight: NonNegative
    qp_solver: Literal["piqp", "clarabel", "daqp"]
    qp_tolerance: Positive
    optimality_tolerance: Positive
    constraint_tolerance_m: Positive
    checker: CheckerConfig
