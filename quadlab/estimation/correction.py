"""The filter's correction by the legs: where the base is relative to standing feet (Bloesch 2012, II-D and III-E)."""

from dataclasses import dataclass

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.estimation.error_state import ERROR_SIZE, FEET, POSITION, FilterState, box_plus, foot_block
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import LEG_COUNT


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

    To first order e_i = dp_i - dr + R n_i with the noise n_i of covariance J_i J_i^T sigma_q^2 + sigma_s^2 I.
    """
    rotation = state.rotation
    values = legs.foot_centers @ rotation.T - state.feet_from_base
    jacobians = rotation @ legs.jacobians
    noise = config.encoder_rad**2 * jacobians @ jacobians.transpose(0, 2, 1) + config.kinematics_m**2 * np.eye(3)
    spread = noise + _relative_covariances(covariance)
    distances = np.einsum("li,li->l", values, np.linalg.solve(spread, values[:, :, None])[:, :, 0])
    return FootInnovations(values, noise, distances)


def measurement_jacobian(feet: list[int]) -> Array:
    """Return H with e = H d for the innovations of ``feet``, (3 n, 27); it does not depend on the state."""
    jacobian = np.zeros((3 * len(feet), ERROR_SIZE))
    for row, leg in enumerate(feet):
        rows = slice(3 * row, 3 * row + 3)
        jacobian[rows, POSITION] = -np.eye(3)
        jacobian[rows, foot_block(leg)] = np.eye(3)
    return jacobian


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
    chosen = np.flatnonzero(feet).tolist()
    if not chosen:
        return Correction(state, covariance)
    jacobian = _JACOBIANS[tuple(chosen)]
    noise = np.zeros((3 * len(chosen), 3 * len(chosen)))
    for row, leg in enumerate(chosen):
        noise[3 * row : 3 * row + 3, 3 * row : 3 * row + 3] = innovations.noise[leg]
    crossed = jacobian @ covariance
    values = innovations.values[chosen].ravel()
    solved = np.linalg.solve(crossed @ jacobian.T + noise, np.column_stack([crossed, values]))
    gain = solved[:, :-1].T
    left = _EYE - gain @ jacobian
    joseph = left @ covariance @ left.T + gain @ noise @ gain.T
    return Correction(box_plus(state, gain @ values), 0.5 * (joseph + joseph.T), float(values @ solved[:, -1]))


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


def _relative_covariances(covariance: Array) -> Array:
    """Return the covariance of dp_i - dr of each foot, (4, 3, 3) in [m^2]."""
    base = covariance[POSITION, POSITION]
    cross = covariance[FEET, POSITION].reshape(LEG_COUNT, 3, 3)
    own = np.einsum("iaib->iab", covariance[FEET, FEET].reshape(LEG_COUNT, 3, LEG_COUNT, 3))
    relative: Array = own + base - cross - cross.transpose(0, 2, 1)
    return relative


_EYE = np.eye(ERROR_SIZE)
_JACOBIANS = {
    tuple(feet): measurement_jacobian(feet)
    for feet in ([leg for leg in range(LEG_COUNT) if flags >> leg & 1] for flags in range(1, 1 << LEG_COUNT))
}
