"""The filter's correction by the legs: where the base is relative to standing feet (Bloesch 2012, II-D and III-E)."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.estimation.error_state import ERROR_SIZE, FEET, FilterState, moved_by, parts
from quadlab.estimation.leg_kinematics import LegKinematics
from quadlab.gaits.schedule import BoolArray
from quadlab.geometry import cholesky
from quadlab.geometry.cholesky import factorise, solve_factor
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry, source_fingerprint
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

    @cached_property
    def numbers(self) -> tuple[float, float, float, int, int]:
        """Variances of encoder and kinematics, gate, blind and patient ticks, as compiled functions take them."""
        variances = self.encoder_rad**2, self.kinematics_m**2
        return *variances, self.gate, self.blind_ticks, self.patience_ticks


@dataclass(frozen=True)
class Correction:
    """The outcome of a correction.

    Attributes:
        state, covariance: after it.
        used: feet whose position was used, (4,) flags.
        refused: standing feet that did not fit, (4,) flags.
        refusals: how often in a row each foot was refused by now, (4,).
        innovation_squared: e^T S^-1 e of all innovations that were used.
    """

    state: FilterState
    covariance: Array
    used: BoolArray
    refused: BoolArray
    refusals: IndexArray
    innovation_squared: float


def correct(
    state: FilterState,
    covariance: Array,
    legs: LegKinematics,
    standing: BoolArray,
    landed: BoolArray,
    refusals: IndexArray,
    config: LegMeasurementConfig,
) -> Correction:
    """Correct by the feet that keep standing, then place those that landed or were refused for too long.

    The innovation of the measured foot s_i in base axes is e_i = R s_i - (p_i - r) (Bloesch 2012, II-D, in world axes),
    to first order e_i = dp_i - dr + R n_i with the noise n_i of covariance J_i J_i^T sigma_q^2 + sigma_s^2 I: the
    measurement's Jacobian H does not depend on the state. With the factor G of the innovations' covariance
    S = H P H^T + N = G G^T and W = G^-1 H P the error is W^T G^-1 e and the covariance P+ = P - W^T W, symmetric by
    construction.

    A foot is placed where the legs say it is: p_i = r + R s_i, hence dp_i = dr - R n_i. Its error is the base's, and no
    other one enters.

    Args:
        state, covariance: before.
        legs: measured.
        standing: feet that stand, (4,) flags.
        landed: those of them that have just begun to, (4,) flags.
        refusals: in a row up to the tick before, (4,).
        config: how well the legs measure, and which feet are believed.
    """
    values, doubt, used, refused, counted, squared = _correct(
        state.values, covariance, legs.foot_centers, legs.jacobians, standing, landed, refusals, config.numbers
    )
    return Correction(FilterState(values), doubt, used, refused, counted, squared)


@compiled
def foot_innovations(
    values: Array,
    covariance: Array,
    foot_centers: Array,
    jacobians: Array,
    encoder_variance: float,
    kinematics_variance: float,
) -> tuple[Array, Array, Array]:
    """Return what all feet measure beyond what is expected, as in ``correct``.

    Args:
        values: of the state, (33,).
        covariance: of its error, (27, 27).
        foot_centers, jacobians: of ``LegKinematics``.
        encoder_variance, kinematics_variance: in [rad^2] and [m^2].

    Returns:
        Innovations e_i in world components, (4, 3) in [m], covariances of their noise, (4, 3, 3) in [m^2], and squared
        Mahalanobis distances, (4,).
    """
    position, _, rotation, feet, _, _ = parts(values)
    innovations, noise, distances = np.empty((LEG_COUNT, 3)), np.empty((LEG_COUNT, 3, 3)), np.empty(LEG_COUNT)
    for leg in range(LEG_COUNT):
        innovations[leg] = rotation @ foot_centers[leg] - (feet[leg] - position)
        jacobian = rotation @ jacobians[leg]
        noise[leg] = encoder_variance * (jacobian @ jacobian.T) + kinematics_variance * np.eye(3)
        foot = _FEET + 3 * leg
        crossed = covariance[foot : foot + 3] - covariance[:3]
        spread = noise[leg] + crossed[:, foot : foot + 3] - crossed[:, :3]
        distances[leg] = innovations[leg] @ np.linalg.solve(spread, innovations[leg])
    return innovations, noise, distances


@compiled
def choose_feet(
    distances: Array, measured: BoolArray, refusals: IndexArray, gate: float, blind_ticks: int
) -> tuple[BoolArray, IndexArray]:
    """Return which feet are used, (4,) flags, and how often in a row each was refused by now, (4,).

    Args:
        distances: squared Mahalanobis distances, (4,).
        measured: feet that stand, (4,) flags.
        refusals: in a row up to the tick before, (4,).
        gate: largest distance of a foot that fits.
        blind_ticks: all are used in spite of it after so many refusals of each of them.
    """
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


@compiled
def _measure(
    values: Array, covariance: Array, innovations: Array, noise: Array, used: BoolArray
) -> tuple[Array, Array, float]:
    """Return values and covariance after the innovations of the feet ``used``, and e^T S^-1 e of ``correct``."""
    feet = np.flatnonzero(used)
    size = 3 * len(feet)
    right, spread = np.empty((size, ERROR_SIZE + 1)), np.zeros((size, size))
    for row, leg in enumerate(feet):
        rows, foot = slice(3 * row, 3 * row + 3), _FEET + 3 * leg
        spread[rows, rows] = noise[leg]
        right[rows, :ERROR_SIZE] = covariance[foot : foot + 3] - covariance[:3]
        right[rows, ERROR_SIZE] = innovations[leg]
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
    return moved_by(error, values), later, squared


@compiled
def _place(values: Array, covariance: Array, foot_center: Array, noise: Array, leg: int) -> None:
    """Put foot number ``leg`` where the legs say it is; noise of that in world components, (3, 3) in [m^2]."""
    position, _, rotation, feet, _, _ = parts(values)
    feet[leg] = position + rotation @ foot_center
    first = _FEET + 3 * leg
    covariance[first : first + 3] = covariance[:3]
    covariance[:, first : first + 3] = covariance[:, :3]
    covariance[first : first + 3, first : first + 3] += noise


def _compile_correction(
    fingerprint: int,
) -> Callable[..., tuple[Array, Array, BoolArray, BoolArray, IndexArray, float]]:
    @compiled_entry
    def corrected(
        values: Array,
        covariance: Array,
        foot_centers: Array,
        jacobians: Array,
        standing: BoolArray,
        landed: BoolArray,
        refusals: IndexArray,
        numbers: tuple[float, float, float, int, int],
    ) -> tuple[Array, Array, BoolArray, BoolArray, IndexArray, float]:
        """Return the attributes of ``Correction``, of the state its values."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of any file here
        encoder_variance, kinematics_variance, gate, blind_ticks, patience_ticks = numbers
        innovations, noise, distances = foot_innovations(
            values, covariance, foot_centers, jacobians, encoder_variance, kinematics_variance
        )
        used, counted = choose_feet(distances, standing & ~landed, refusals, gate, blind_ticks)
        if used.any():
            later, doubt, squared = _measure(values, covariance, innovations, noise, used)
        else:
            later, doubt, squared = values.copy(), covariance.copy(), 0.0
        refused = counted > 0
        for leg in range(LEG_COUNT):
            if landed[leg] or counted[leg] > patience_ticks:
                _place(later, doubt, foot_centers[leg], noise[leg], leg)
                counted[leg] = 0
        return later, doubt, used, refused, counted, squared

    return corrected


_correct = _compile_correction(
    source_fingerprint(Path(__file__).parent) ^ source_fingerprint(Path(cholesky.__file__).parent)
)
