"""The regulariser of Gehring 2017, Section II: of the many solutions the one near the nominal stance."""

import numpy as np

from quadlab.gaits.schedule import BoolArray
from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import LinearTerm, rows
from quadlab.robots.pinocchio_model import IndexArray


def nominal_stance(layout: SampleLayout, base_height: float, joints: Array, weight: float) -> LinearTerm:
    """Return base height, level base and joints as in the nominal stance.

    The paper prints neither form nor weight. The weight decides the speed of convergence.

    Args:
        layout: of p.
        base_height: nominal, in [m].
        joints: nominal, (12,) in [rad].
        weight: in [1/m^2], [1/rad^2].
    """
    height, tilt = layout.indices("base_position")[:, 2:], layout.indices("base_rotation")[:, 1:]
    index = np.concatenate([height, tilt, layout.indices("joints")], axis=1)
    target = np.tile([base_height, 0.0, 0.0, *joints], layout.samples)
    return _held("regulariser", index, target, layout.size, weight)


def even_loads(layout: SampleLayout, support: BoolArray, weight: float) -> LinearTerm:
    """Return equal shares of all feet that carry.

    Args:
        layout: of p.
        support: which feet may carry, (N, 4).
        weight: of the squared differences.
    """
    shares = support / support.sum(axis=1, keepdims=True)
    return _held("even_loads", layout.indices("loads")[support], shares[support], layout.size, weight)


def _held(name: str, index: IndexArray, target: Array, size: int, weight: float) -> LinearTerm:
    return LinearTerm(name, weight, rows([(index.ravel(), 1.0)], size), target.ravel())
