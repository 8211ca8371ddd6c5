"""The settings of the kinematic planner."""

from typing import Annotated, Literal

from pydantic import Field

from quadlab.configuration import Fraction, NonNegative, Positive, StrictModel
from quadlab.planners.checker import CheckerConfig


class ObjectiveWeights(StrictModel):
    """Weights alpha_j of Eq. (1); the first ten are those of Gehring 2017, Table I.

    Attributes:
        com_consistency, feet_consistency: Eq. (3), in [1/m^2].
        dynamic_stability: Eq. (7) and (8), in [1/m^2].
        travel_distance_transition, travel_distance_periodic: Eq. (9) of single and of repeated cycles, in [1/m^2].
        turning_angle_periodic: Eq. (9) of repeated cycles, in [1/rad^2].
        smooth_base, smooth_joints, smooth_com, smooth_feet: Eq. (5) in units of the sample period, in [1/m^2],
            [1/rad^2].
        turning_angle_transition: Eq. (9) of single cycles, in [1/rad^2].
        regulariser: base height, roll, pitch and joints as in the nominal stance, in [1/m^2], [1/rad^2].
        even_loads: w_k equal among the feet that carry.
    """

    com_consistency: NonNegative
    feet_consistency: NonNegative
    dynamic_stability: NonNegative
    travel_distance_transition: NonNegative
    travel_distance_periodic: NonNegative
    turning_angle_periodic: NonNegative
    smooth_base: NonNegative
    smooth_joints: NonNegative
    smooth_com: NonNegative
    smooth_feet: NonNegative
    turning_angle_transition: NonNegative
    regulariser: NonNegative
    even_loads: NonNegative


class SqpConfig(StrictModel):
    """Settings of the sequential quadratic program.

    Attributes:
        max_iterations: limit; more is reported as solver_limit.
        max_wall_time_s: limit, looked at between iterations, in [s]; whether it ends them depends on the machine, and
            the reason says so.
        convergence: the objective has converged when neither the model nor the step changes it by more than this share.
        damping: added to the diagonal of the Gauss-Newton Hessian.
        armijo: smallest share of the predicted decrease that a step must reach.
        smallest_step: shortest step that is tried, as a share of the full one.
        qp_solver: which solver finds the step.
        qp_tolerance: accuracy asked of the solver of the quadratic programs.
        qp_residual: largest residual of its optimality conditions that is accepted, relative to the gradient.
    """

    max_iterations: Annotated[int, Field(ge=1)]
    max_wall_time_s: Positive
    convergence: Positive
    damping: Positive
    armijo: Annotated[float, Field(gt=0.0, lt=0.5)]
    smallest_step: Annotated[float, Field(gt=0.0, le=1.0)]
    qp_solver: Literal["proxqp", "piqp", "osqp"]
    qp_tolerance: Positive
    qp_residual: Positive


class KinematicSqpConfig(StrictModel):
    """Settings of the kinematic planner.

    Attributes:
        name: of the planner in results; several files may be of one kind.
        samples_per_cycle: samples of a cycle with steps; contacts switch at the samples nearest to the switches of the
            schedule, by which the checker judges.
        samples_per_rest: largest number of samples of a stance before, between or after the steps.
        clearance_m: height of a foot in the middle of its swing in [m].
        least_load: smallest share w_min of a foot that carries, Eq. (8).
        joint_speed_radps: speed limit of all joints, Eq. (6), in [rad/s].
        weights: of the objectives.
        sqp: the solver.
        constraint_tolerance: largest violation of any constraint set in its own unit.
        consistency_mm: largest distance of auxiliary CoM and feet from those of the configuration, Eq. (3), in [mm].
        cop_outside_polygon_mm: replaces ``checker.cop_outside_mm`` if three or more feet stand all the time, in [mm].
        checker: tolerances of the independent checker.
    """

    kind: Literal["kinematic_sqp"]
    name: str
    samples_per_cycle: Annotated[int, Field(ge=4)]
    samples_per_rest: Annotated[int, Field(ge=2)]
    clearance_m: NonNegative
    least_load: Fraction
    joint_speed_radps: Positive
    weights: ObjectiveWeights
    sqp: SqpConfig
    constraint_tolerance: Positive
    consistency_mm: Positive
    cop_outside_polygon_mm: NonNegative
    checker: CheckerConfig
