"""Where every variable of every sample sits in the vector p: the only place that knows."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_COUNT, LEG_COUNT
from quadlab.robots.pinocchio_model import IndexArray

BLOCKS = {
    "base_position": 3,
    "base_rotation": 3,
    "joints": JOINT_COUNT,
    "com": 3,
    "feet": 2 * LEG_COUNT,
    "loads": LEG_COUNT,
}
"""Blocks of p_i, Eq. (2), and their sizes; the rotation is yaw, pitch, roll."""

POSE_BLOCKS = ("base_position", "base_rotation", "joints")
"""The blocks that make up the configuration q_i, (18,)."""

POSE_SIZE = sum(BLOCKS[name] for name in POSE_BLOCKS)
SAMPLE_SIZE = sum(BLOCKS.values())


def block_columns(name: str) -> slice:
    """Return where block ``name`` sits in one p_i."""
    names = list(BLOCKS)
    begin = sum(BLOCKS[other] for other in names[: names.index(name)])
    return slice(begin, begin + BLOCKS[name])


@dataclass(frozen=True)
class SampleLayout:
    """The vector p = [p_1, ..., p_N] with p_i = [q_i, x_i, e_1..e_4, w_1..w_4], Eq. (2).

    Attributes:
        samples: their number N.
    """

    samples: int

    @property
    def size(self) -> int:
        """Length of p."""
        return self.samples * SAMPLE_SIZE

    def indices(self, name: str) -> IndexArray:
        """Return the indices of block ``name`` in p, (samples, size of the block)."""
        table = np.arange(self.size, dtype=np.intp).reshape(self.samples, SAMPLE_SIZE)
        return table[:, block_columns(name)]

    def pose_indices(self) -> IndexArray:
        """Return the indices of the configurations in p, (samples, 18)."""
        return np.concatenate([self.indices(name) for name in POSE_BLOCKS], axis=1)

    def foot_indices(self) -> IndexArray:
        """Return the indices of the foot positions in p, (samples, 4, 2)."""
        return self.indices("feet").reshape(self.samples, LEG_COUNT, 2)

    def value(self, name: str, p: Array) -> Array:
        """Return block ``name`` of a (size,) vector, (samples, size of the block)."""
        return p.reshape(self.samples, SAMPLE_SIZE)[:, block_columns(name)]

    def poses(self, p: Array) -> Array:
        """Return the configurations q_i, (samples, 18)."""
        return p.reshape(self.samples, SAMPLE_SIZE)[:, :POSE_SIZE]

    def feet(self, p: Array) -> Array:
        """Return the foot positions over the ground, (samples, 4, 2) in [m]."""
        return self.value("feet", p).reshape(self.samples, LEG_COUNT, 2)
