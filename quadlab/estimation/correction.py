"""The filter's correction by the legs: where the base is relative to standing feet (Bloesch 2012, II-D and III-E)."""

from dataclasses import dataclass

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.estimation.error_state import ERROR_SIZE, FEET, POSITION, FilterState, box_plus, foot_block
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.pinocchio_model import IndexArray

_FEET = FEET.start
"""First row of the feet in the error."""


class LegMeasurementConfig(StrictModel):
    """How well the legs measure.

    Attributes:
        encoder_rad: standard deviation of a joint angle in [rad].
        kinematics_m: standard deviation of a foot position by errors of the kinematic model in [m].
        gate: squared Mahalanobis distance (3 degrees of freedom) beyond which a foot counts as slipping.
        blind_ticks: after so many refusals in a row of all standing feet they are used in spite of the gate.
        patience_ticks: after so many refusals in a row a standing foot starts anew where the legs say it is.
    """

    encoder_rad: NonNegative
    kinematics_m: Positive
    gate: Positive
    blind_ticks: int
    patience_ticks: int


@dataclass(frozen=True)
class FootInnovations:
    """Measured minus predicted foot positions relative to the base, of all feet.

    Attributes:
        values: in world components, (4, 3) in [m].
        noise: covariance of the measurements in world components, (4, 3, 3) in [m^2].
        distances: squared Mahalanobis distance of each foot, (4,).
    """

    values: Array
    noise: Array
    distances: Array


def foot_innovations(
    state: FilterState, covariance: Array, legs: LegKinematics, config: LegMeasurementConfig
) -> FootInnovations:
    """Return e_i = R s_i - (p_i - r) for the measured foot s_i in base axes (Bloesch 2012, II-D, in world axes).

    To first order e_i = dp_i - dr + R n_i with the noise n_i of covariance J_i J_i^T sigma_q^2 + sigma_s^2 I: the
    measurement's Jacobian H does not depend on the state.
    """
    return FootInnovations(
        *_foot_innovations(
            state.rotation,
            state.feet_from_base,
            legs.foot_centers,
            legs.jacobians,
            covariance,
            config.encoder_rad**2,
            config.kinematics_m**2,
        )
    )


@dataclass(frozen=True)
class Correction:
    """The outcome of a correction.

    Attributes:
        state, covariance: after it.
        innovation_squared: e^T S^-1 e of all innovations that were used.
    """

    state: FilterState
    covariance: Array
    innovation_squared: float = 0.0


def correct(state: FilterState, covariance: Array, innovations: FootInnovations, feet: BoolArray) -> Correction:
    """Return state and covariance after the measurements of ``feet``, (4,) flags.

    The covariance is updated in Joseph's form, P+ = (I - K H) P (I - K H)^T + K N K^T, and made symmetric.
    """
    if not feet.any():
        return Correction(state, covariance)
    error, corrected, squared = _correct(covariance, innovations.values, innovations.noise, np.flatnonzero(feet))
    return Correction(box_plus(state, error), corrected, squared)


def place_foot(
    state: FilterState, covariance: Array, legs: LegKinematics, noise: Array, leg: int
) -> tuple[FilterState, Array]:
    """Return state and covariance after a foot has touched down where the legs say it is.

    p_i = r + R s_i, hence dp_i = dr - R n_i: the foot's error is the base's, and no other error enters.

    Args:
        state, covariance: before.
        legs: measured.
        noise: of the measurement in world components, (3, 3) in [m^2].
        leg: number of the foot.
    """
    feet = state.feet.copy()
    feet[leg] = state.position + state.rotation @ legs.foot_centers[leg]
    foot = foot_block(leg)
    placed = covariance.copy()
    placed[foot] = placed[POSITION]
    placed[:, foot] = placed[:, POSITION]
    placed[foot, foot] += noise
    moved = FilterState(state.position, state.velocity, state.rotation, feet, state.accelerometer_bias, state.gyro_bias)
    return moved, placed


@compiled_entry
def _foot_innovations(
    rotation: Array,
    feet_from_base: Array,
    foot_centers: Array,
    jacobians: Array,
    covariance: Array,
    encoder_variance: float,
    kinematics_variance: float,
) -> tuple[Array, Array, Array]:
    """Return values (4, 3), noise (4, 3, 3) and distances (4,) of ``foot_innovations``; variances in [rad^2], [m^2]."""
    values, noise = np.empty((LEG_COUNT, 3)), np.empty((LEG_COUNT, 3, 3))
    distances = np.empty(LEG_COUNT)
    for leg in range(LEG_COUNT):
        values[leg] = rotation @ foot_centers[leg] - feet_from_base[leg]
        jacobian = rotation @ jacobians[leg]
        noise[leg] = encoder_variance * (jacobian @ jacobian.T) + kinematics_variance * np.eye(3)
        foot = _FEET + 3 * leg
        crossed = covariance[foot : foot + 3] - covariance[:3]
        spread = noise[leg] + crossed[:, foot : foot + 3] - crossed[:, :3]
        distances[leg] = values[leg] @ np.linalg.solve(spread, values[leg])
    return values, noise, distances


@compiled_entry
def _correct(covariance: Array, values: Array, noise: Array, feet: IndexArray) -> tuple[Array, Array, float]:
    """Return the error (27,), the covariance (27, 27) and e^T S^-1 e of ``correct`` for the numbers of the ``feet``."""
    size = 3 * len(feet)
    crossed, spread, innovation = np.empty((size, ERROR_SIZE)), np.zeros((size, size)), np.empty(size)
    for row, leg in enumerate(feet):
        rows, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
        innovation[rows] = values[leg]
        spread[rows, rows] = noise[leg]
        crossed[rows] = covariance[foot : foot + 3] - covariance[:3]
    noise_of_feet = spread.copy()
    for row, leg in enumerate(feet):
        columns, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
        spread[:, columns] += crossed[:, foot : foot + 3] - crossed[:, :3]
    gain = np.linalg.solve(spread, crossed).T.copy()
    left = np.eye(ERROR_SIZE)
    for row, leg in enumerate(feet):
        columns, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
        left[:, :3] += gain[:, columns]
        left[:, foot : foot + 3] -= gain[:, columns]
    joseph = left @ covariance @ left.T + gain @ noise_of_feet @ gain.T
    squared = float(innovation @ np.linalg.solve(spread, innovation))
    return gain @ innovation, 0.5 * (joseph + joseph.T), squared
