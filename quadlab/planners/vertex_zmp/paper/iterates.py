"""The iterates of a CasADi solver, kept as it goes."""

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from quadlab.geometry.rotations import Array


class IterateRecorder(ca.Callback):
    """Remembers the unknowns of every iterate; given to ``nlpsol`` as its iteration callback.

    Attributes:
        iterates: those of the solve under way, (n,) each, the first guess first.
    """

    def __init__(self, unknowns: int, constraints: int, parameters: int) -> None:
        ca.Callback.__init__(self)
        self.iterates: list[Array] = []
        self._sizes = {"x": unknowns, "lam_x": unknowns, "g": constraints, "lam_g": constraints, "lam_p": parameters}
        self.construct("iterates", {})

    def get_n_in(self) -> int:
        """Return the number of inputs, as CasADi asks."""
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        """Return the number of outputs, as CasADi asks."""
        return 1

    def get_name_in(self, index: int) -> str:
        """Return the name of an input, as CasADi asks."""
        return str(ca.nlpsol_out(index))

    def get_sparsity_in(self, index: int) -> Any:
        """Return the shape of an input, as CasADi asks."""
        return ca.Sparsity.dense(self._sizes.get(self.get_name_in(index), 1))

    def eval(self, values: Sequence[Any]) -> Sequence[Any]:
        """Keep the iterate; 0 lets the solver go on."""
        self.iterates.append(np.array(values[0]).ravel())
        return [0]
