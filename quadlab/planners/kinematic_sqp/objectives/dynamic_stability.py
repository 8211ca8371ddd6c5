"""Eq. (7) and (8): the CoP of an inverted pendulum is the weighted mean of the feet that carry."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array, rotation_z
from quadlab.planners.kinematic_sqp.grid import CycleSpan, SampleGrid
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import Coordinates, Jacobians
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.pinocchio_model import IndexArray

_NEIGHBOURS = 4  # CoM samples from which an acceleration follows
_LOADS = slice(3 * _NEIGHBOURS, 3 * _NEIGHBOURS + LEG_COUNT)


@dataclass(frozen=True)
class DynamicStability:
    """Residual sum_k w_k e_k - x + z a_xy / (a_z + g), a the finite difference of the CoM.

    Where a cycle repeats, the sample after its last one is the one after its first, turned by the command.

    Attributes:
        weight: in [1/m^2].
        gravity: g in [m/s^2].
        difference: acceleration of each group from four CoM samples, (groups, 3, 12) in [1/s^2].
        variables: four CoM samples, the second of which is x; loads; feet, (groups, 24).
    """

    weight: float
    gravity: float
    difference: Array
    variables: IndexArray
    name: str = "dynamic_stability"

    def residual(self, p: Array, coordinates: Coordinates) -> Array:
        """Return the distance of weighted feet and CoP, (groups, 2) in [m]."""
        com, acceleration, loads, feet = self._parts(p)
        lever = com[:, 2] / (acceleration[:, 2] + self.gravity)
        cop = com[:, :2] - lever[:, None] * acceleration[:, :2]
        distance: Array = np.einsum("sk,skd->sd", loads, feet) - cop
        return distance

    def jacobian(self, p: Array, jacobians: Jacobians) -> Array:
        """Return the derivative, (groups, 2, 24)."""
        com, acceleration, loads, feet = self._parts(p)
        fall = acceleration[:, 2] + self.gravity
        lever = com[:, 2] / fall
        jacobian = np.zeros((len(self.variables), 2, self.variables.shape[1]))
        by_com = lever[:, None, None] * self.difference[:, :2]
        by_com -= (lever / fall)[:, None, None] * acceleration[:, :2, None] * self.difference[:, 2:]
        by_com[:, :, 3:5] -= np.eye(2)
        by_com[:, :, 5] += acceleration[:, :2] / fall[:, None]
        jacobian[:, :, : _LOADS.start] = by_com
        jacobian[:, :, _LOADS] = feet.transpose(0, 2, 1)
        for axis in range(2):
            jacobian[:, axis, _LOADS.stop + axis :: 2] = loads
        return jacobian

    def _parts(self, p: Array) -> tuple[Array, Array, Array, Array]:
        """Return CoM (groups, 3), acceleration (groups, 3), loads (groups, 4) and feet (groups, 4, 2)."""
        local = p[self.variables]
        acceleration = np.einsum("sdj,sj->sd", self.difference, local[:, : _LOADS.start])
        feet = local[:, _LOADS.stop :].reshape(-1, LEG_COUNT, 2)
        return local[:, 3:6], acceleration, local[:, _LOADS], feet


def dynamic_stability(layout: SampleLayout, grid: SampleGrid, gravity: float, weight: float) -> DynamicStability:
    """Return the objective for all samples but the first, which is given.

    Args:
        layout: of p.
        grid: samples and repeated cycles.
        gravity: in [m/s^2].
        weight: in [1/m^2].
    """
    groups = [_inner(grid, sample) for sample in range(1, grid.samples - 1)]
    groups += [_wrapped(grid, span) for span in grid.wraps]
    if grid.ends_at_rest:
        last = grid.samples - 1
        groups.append(([last - 1, last, last, last], np.zeros((3, 3 * _NEIGHBOURS))))
    com, loads, feet = layout.indices("com"), layout.indices("loads"), layout.indices("feet")
    variables = [np.concatenate([*com[near], loads[near[1]], feet[near[1]]]) for near, _ in groups]
    return DynamicStability(weight, gravity, np.array([matrix for _, matrix in groups]), np.array(variables))


def _inner(grid: SampleGrid, sample: int) -> tuple[list[int], Array]:
    """Return the samples from which the acceleration at an inner sample follows, and the matrix (3, 12)."""
    before, after = grid.periods_s[sample - 1], grid.periods_s[sample]
    factors = np.array([1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after, 0.0]) * 2.0 / (before + after)
    return [sample - 1, sample, sample + 1, sample], np.kron(factors, np.eye(3))


def _wrapped(grid: SampleGrid, span: CycleSpan) -> tuple[list[int], Array]:
    """Return the same at the end of a cycle that is followed by itself: x_{N+1} - x_N = R (x_{p+1} - x_p)."""
    before, after = grid.periods_s[span.last - 1], grid.periods_s[span.first]
    turn = rotation_z(float(span.cycle.increment[2])) / after
    matrix = np.hstack([np.eye(3) / before, -np.eye(3) / before, turn, -turn])
    return [span.last - 1, span.last, span.first + 1, span.first], matrix * 2.0 / (before + after)
