"""Named blocks of a vector: the only place that knows where a variable or parameter sits."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from quadlab.geometry.rotations import Array


@dataclass(frozen=True)
class BlockLayout:
    """A vector that holds named matrices one after the other, each column by column.

    Attributes:
        shapes: (rows, columns) of each block, in the order of the vector.
    """

    shapes: Mapping[str, tuple[int, int]]

    @property
    def size(self) -> int:
        """Length of the vector."""
        return sum(rows * columns for rows, columns in self.shapes.values())

    def block(self, name: str) -> slice:
        """Return where block ``name`` sits in the vector."""
        begin = 0
        for other, (rows, columns) in self.shapes.items():
            if other == name:
                return slice(begin, begin + rows * columns)
            begin += rows * columns
        raise KeyError(f"{name}: no such block; blocks are {', '.join(self.shapes)}")

    def symbol(self, name: str, vector: Any) -> Any:
        """Return block ``name`` of a CasADi column vector as a CasADi matrix."""
        rows, columns = self.shapes[name]
        return vector[self.block(name)].reshape((rows, columns))

    def value(self, name: str, vector: Array) -> Array:
        """Return block ``name`` of a (size,) array as a (rows, columns) array."""
        return vector[self.block(name)].reshape(self.shapes[name], order="F")

    def pack(self, values: Mapping[str, Array]) -> Array:
        """Return the (size,) vector with the given blocks; every block must be given."""
        vector = np.empty(self.size)
        for name, shape in self.shapes.items():
            vector[self.block(name)] = np.broadcast_to(values[name], shape).ravel(order="F")
        return vector
