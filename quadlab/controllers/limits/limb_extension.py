"""Hips that stay within reach of their feet in height (Bellicoso 2016, Eq. 35): what adapts the body to the terrain."""

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np

from quadlab.configuration import register
from quadlab.controllers.limits.second_order import HeightRangeConfig, acceleration_bounds
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_rows
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled, compiled_entry, source_fingerprint
from quadlab.robots.kinematics import VELOCITY_SIZE, Kinematics
from quadlab.robots.legs import LEG_COUNT


@register("task", "limb_extension")
class LimbExtensionLimit:
    """h_min <= z_hip - z_foot <= h_max for each leg; the foot's own motion is not part of the limit."""

    class Config(HeightRangeConfig):
        """How far a leg may reach: height of the hip over its foot."""

        task: Literal["limb_extension"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._rows = empty_rows(Variable.ACCELERATION, LEG_COUNT, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations for each leg."""
        _write_rows(
            kinematics.base_jacobian,
            kinematics.base_bias,
            kinematics.base_angular_velocity,
            kinematics.generalized_velocity,
            kinematics.base_position,
            (kinematics.hip_positions, kinematics.foot_positions),
            self.config.bounds(reference.standing_height),
            self.config.look_ahead_s,
            (self._rows.matrix, self._rows.lower, self._rows.upper),
        )
        return self._rows


@compiled
def _hip_heights(
    base_jacobian: Array,
    base_bias: Array,
    omega: Array,
    u: Array,
    base: Array,
    hips_and_feet: tuple[Array, Array],
    jacobian: Array,
) -> tuple[Array, Array, Array]:
    """Write J (4, 18) of the heights of the hips and return J_dot u, the heights over the feet and J u, (4,) each.

    The z components of r_ddot_B + omega_dot x arm + omega x (omega x arm), with the arms from ``base`` to the hips.
    """
    hips, feet = hips_and_feet
    bias, heights, speeds = np.empty(len(hips)), hips[:, 2] - feet[:, 2], np.zeros(len(hips))
    for leg in range(len(hips)):
        x, y, z = hips[leg, 0] - base[0], hips[leg, 1] - base[1], hips[leg, 2] - base[2]
        jacobian[leg] = base_jacobian[2] + y * base_jacobian[3] - x * base_jacobian[4]
        along = omega[0] * x + omega[1] * y + omega[2] * z
        centripetal = omega[2] * along - (omega[0] ** 2 + omega[1] ** 2 + omega[2] ** 2) * z
        bias[leg] = base_bias[2] + y * base_bias[3] - x * base_bias[4] + centripetal
        for column in range(len(u)):
            speeds[leg] += jacobian[leg, column] * u[column]
    return bias, heights, speeds


def _compile_rows(fingerprint: int) -> Callable[..., None]:
    @compiled_entry
    def write_rows(
        base_jacobian: Array,
        base_bias: Array,
        omega: Array,
        u: Array,
        base: Array,
        hips_and_feet: tuple[Array, Array],
        bounds: tuple[float, float],
        dt: float,
        rows: tuple[Array, Array, Array],
    ) -> None:
        """Write matrix (4, 18), lower and upper (4,) of the limit, whose ``bounds`` are in [m], to ``rows``."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of what is called
        matrix, lower, upper = rows
        bias, heights, speeds = _hip_heights(base_jacobian, base_bias, omega, u, base, hips_and_feet, matrix)
        lower[:], upper[:] = acceleration_bounds(bias, heights, speeds, bounds, dt)

    return write_rows


_write_rows = _compile_rows(source_fingerprint(Path(__file__).parent))
