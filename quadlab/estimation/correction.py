"""The filter's correction by the legs: where the base is relative to standing feet (Bloesch 2012, II-D and III-E)."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.estimation.error_state import (
    ERROR_SIZE,
    FEET,
    POSITION,
    FilterArrays,
    FilterState,
    foot_block,
    moved_by,
)
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry import cholesky
from quadlab.geometry.cholesky import factorise, solve_factor
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, source_fingerprint
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
    blind_ticks: Annotated[int, Field(ge=0)]
    patience_ticks: Annotated[int, Field(ge=0)]


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

    With the factor G of the innovation's covariance S = H P H^T + N = G G^T and W = G^-1 H P the error is W^T G^-1 e
    and the covariance P+ = P - W^T W, symmetric by construction.
    """
    if not feet.any():
        return Correction(state, covariance)
    arrays, corrected, squared = _correct(state.arrays, covariance, innovations.values, innovations.noise, feet)
    return Correction(FilterState(*arrays), corrected, squared)


def choose_feet(
    distances: Array, measured: BoolArray, refusals: IndexArray, config: LegMeasurementConfig
) -> tuple[BoolArray, IndexArray]:
    """Return which feet are used, (4,) flags, and how often in a row each was refused by now, (4,).

    Args:
        distances: squared Mahalanobis distances, (4,).
        measured: feet that stand, (4,) flags.
        refusals: in a row up to the tick before, (4,).
        config: gate, and when all standing feet are used in spite of it.
    """
    return _choose_feet(distances, measured, refusals, config.gate, config.blind_ticks)


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
def _choose_feet(
    distances: Array, measured: BoolArray, refusals: IndexArray, gate: float, blind_ticks: int
) -> tuple[BoolArray, IndexArray]:
    """Return flags and refusals of ``choose_feet``."""
    used, blind = measured & (distances <= gate), True
    for leg in range(len(measured)):
        if used[leg] or (measured[leg] and refusals[leg] < blind_ticks):
            blind = False
    if blind:
        used = measured.copy()
    counted = np.zeros_like(refusals)
    for leg in range(len(measured)):
        if measured[leg] and not used[leg]:
            counted[leg] = refusals[leg] + 1
    return used, counted


def _compile_correction(fingerprint: int) -> Callable[..., tuple[FilterArrays, Array, float]]:
    @compiled_entry
    def corrected(
        state: FilterArrays, covariance: Array, values: Array, noise: Array, used: BoolArray
    ) -> tuple[FilterArrays, Array, float]:
        """Return the state's arrays, the covariance (27, 27) and e^T S^-1 e of ``correct``."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        feet = np.flatnonzero(used)
        size = 3 * len(feet)
        right, spread = np.empty((size, ERROR_SIZE + 1)), np.zeros((size, size))
        for row, leg in enumerate(feet):
            rows, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
            spread[rows, rows] = noise[leg]
            right[rows, :ERROR_SIZE] = covariance[foot : foot + 3] - covariance[:3]
            right[rows, ERROR_SIZE] = values[leg]
        for row, leg in enumerate(feet):
            columns, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
            spread[:, columns] += right[:, foot : foot + 3] - right[:, :3]
        factorise(spread)
        solve_factor(spread, right)  # G^-1 [H P, e] with S = G G^T
        error, later, squared = np.zeros(ERROR_SIZE), np.empty_like(covariance), 0.0
        for row in range(size):
            whitened = right[row, ERROR_SIZE]
            squared += whitened * whitened
            for i in range(ERROR_SIZE):
                error[i] += right[row, i] * whitened
        for i in range(ERROR_SIZE):
            for j in range(i + 1):
                value = covariance[i, j]
                for row in range(size):
                    value -= right[row, i] * right[row, j]
                later[i, j] = value
                later[j, i] = value
        position, velocity, rotation, centers, accelerometer, gyro = state
        moved = moved_by(error, position, velocity, rotation, centers, accelerometer, gyro)
        return moved, later, squared

    return corrected


_correct = _compile_correction(
    source_fingerprint(Path(__file__).parent) ^ source_fingerprint(Path(cholesky.__file__).parent)
)
