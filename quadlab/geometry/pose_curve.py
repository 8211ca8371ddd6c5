"""The smooth motion of a body through poses at given times.

Gehring 2017, section III-C: a third-order Hermite spline with unit quaternions as proposed by Kim, Kim and Shin,
"A general construction scheme for unit quaternion curves with simple high order derivatives", 1995.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from quadlab.errors import QuadlabError
from quadlab.geometry.quaternions import quat_exp, quat_inverse, quat_log, quat_product
from quadlab.geometry.rotations import Array

UNIT_TOLERANCE = 1e-6
"""How far the norm of a quaternion may be from 1."""


class PoseMotion(NamedTuple):
    """A moving pose at one time; all components are in the axes of one frame: the plan's for a curve of a plan.

    Attributes:
        position, velocity, acceleration: (3,) in [m], [m/s], [m/s^2].
        rotation: base to that frame, (3, 3).
        angular_velocity, angular_acceleration: (3,) in [rad/s], [rad/s^2].
    """

    position: Array
    velocity: Array
    acceleration: Array
    rotation: Array
    angular_velocity: Array
    angular_acceleration: Array


@dataclass(frozen=True)
class PoseCurve:
    """m pieces of a once continuously differentiable curve of poses, see :func:`pose_curve`.

    In the local time s of a piece of duration h, with u = s / h, the position is a cubic and the orientation the cubic
    Hermite quaternion curve of Kim 1995,

        q = q0 exp(w_1 b_1) exp(w_2 b_2) exp(w_3 b_3),  b_1 = 1 - (1 - u)^3,  b_2 = 3 u^2 - 2 u^3,  b_3 = u^3

    where exp takes rotation vectors; Kim's w_i are half of them. Outside its span the curve stands still at the pose of
    its end, with zero derivatives.

    Attributes:
        knots: (m + 1,) increasing times in [s]; a single time for the pose that never moves.
        durations: h, (m,) in [s].
        coefficients: (m, 4, 3); entry [k, i] multiplies s**i and gives [m].
        quats_wxyz: q0, base to plan frame, (m, 4).
        turns: w_1, w_2, w_3, (m, 3, 3) in [rad].
    """

    knots: Array
    durations: Array
    coefficients: Array
    quats_wxyz: Array
    turns: Array

    @cached_property
    def _compiled_motion(self) -> Callable[..., Array]:
        from quadlab.geometry.pose_motion import pose_motion  # noqa: PLC0415

        return pose_motion

    def motion(self, time_s: float) -> PoseMotion:
        """Return pose, velocities and accelerations at ``time_s`` in [s]; at a knot those of the later piece."""
        rows = self._compiled_motion(self.knots, self.durations, self.coefficients, self.quats_wxyz, self.turns, time_s)
        return PoseMotion(rows[0], rows[1], rows[2], rows[3:6], rows[6], rows[7])


def pose_curve(times_s: Array, positions: Array, quats_wxyz: Array) -> PoseCurve:
    """Return the curve through n >= 1 poses that begins and ends at rest.

    The velocity at an inner sample is that of the parabola through it and its two neighbours; the angular velocity is
    the same mean of the constant ones that lead from the neighbour before and to the one after, by at most half a turn
    each. Gehring 2017 does not say how they are chosen.

    Args:
        times_s: (n,) increasing in [s].
        positions: (n, 3) in [m].
        quats_wxyz: base to plan frame, (n, 4) of norm 1; either sign.

    Raises:
        QuadlabError: if the samples are not of that kind.
    """
    times, points, quats = (np.array(samples, dtype=np.float64) for samples in (times_s, positions, quats_wxyz))
    _check(times, points, quats)
    quats = _of_continuous_sign(quats / np.linalg.norm(quats, axis=1, keepdims=True))
    durations = np.diff(times)
    if len(times) == 1:
        durations, points, quats = np.ones(1), np.repeat(points, 2, axis=0), np.repeat(quats, 2, axis=0)
    return PoseCurve(times, durations, _cubics(durations, points), quats[:-1], _turns(durations, quats))


def _check(times: Array, positions: Array, quats: Array) -> None:
    """Raise if the samples are not n times that increase, n positions and n unit quaternions."""
    shapes = [samples.shape for samples in (times, positions, quats)]
    if times.ndim != 1 or times.size == 0 or shapes[1:] != [(times.size, 3), (times.size, 4)]:
        found = ", ".join(map(str, shapes))
        raise QuadlabError(f"pose curve: expected times (n,), positions (n, 3), quaternions (n, 4), found {found}")
    if not (np.isfinite(times).all() and np.isfinite(positions).all()):
        raise QuadlabError("pose curve: expected finite times and positions, found inf or nan")
    if (steps := np.diff(times)).size and steps.min() <= 0.0:
        late = int(np.argmin(steps > 0.0))
        raise QuadlabError(f"pose curve: times must increase, found {times[late + 1]:g} s after {times[late]:g} s")
    norms = np.linalg.norm(quats, axis=1)
    if (wrong := ~(np.abs(norms - 1.0) <= UNIT_TOLERANCE)).any():
        sample = int(np.argmax(wrong))
        raise QuadlabError(f"pose curve: quaternions must have norm 1, that of sample {sample} has {norms[sample]:.9g}")


def _of_continuous_sign(quats: Array) -> Array:
    """Return the quaternions, (n, 4), each with the sign that is closer to the one before."""
    flips = np.where(np.sum(quats[1:] * quats[:-1], axis=1) < 0.0, -1.0, 1.0)
    return np.vstack([quats[:1], np.cumprod(flips)[:, None] * quats[1:]])


def _node_rates(durations: Array, slopes: Array) -> Array:
    """Return rates at the n samples, (n, 3), from the mean ones between them, (n - 1, 3); zero at both ends."""
    before, after = durations[:-1, None], durations[1:, None]
    inner = (after * slopes[:-1] + before * slopes[1:]) / (before + after)
    return np.vstack([np.zeros((1, 3)), inner, np.zeros((1, 3))])


def _cubics(durations: Array, positions: Array) -> Array:
    """Return the Hermite cubics through the positions, (n, 3) in [m]: (n - 1, 4, 3) ascending powers."""
    h = durations[:, None]
    slopes = np.diff(positions, axis=0) / h
    rates = _node_rates(durations, slopes)
    first, last = rates[:-1], rates[1:]
    return np.stack(
        [positions[:-1], first, (3.0 * slopes - 2.0 * first - last) / h, (first + last - 2.0 * slopes) / h**2], 1
    )


def _turns(durations: Array, quats: Array) -> Array:
    """Return w_1, w_2, w_3 of each piece through unit quaternions of continuous sign, (n, 4): (n - 1, 3, 3) in [rad].

    Kim 1995, Hermite quaternion curve: with the angular velocities v_a and v_b at the ends of a piece, in the axes of
    the body, w_1 = h v_a / 3, w_3 = h v_b / 3 and exp(w_2) = exp(w_1)^-1 q_a^-1 q_b exp(w_3)^-1.
    """
    h = durations[:, None]
    between = quat_product(quat_inverse(quats[:-1]), quats[1:])
    rates = _node_rates(durations, quat_log(between) / h)
    first, last = h * rates[:-1] / 3.0, h * rates[1:] / 3.0
    middle = quat_log(quat_product(quat_exp(-first), quat_product(between, quat_exp(-last))))
    return np.stack([first, middle, last], axis=1)
