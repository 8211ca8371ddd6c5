"""The largest value that is survived: bisection on a grid."""

from dataclasses import dataclass, field

import numpy as np

from quadlab.studies.config import SearchConfig


@dataclass
class BoundarySearch:
    """Asks for one grid value after the other until the limit is found.

    Bisection assumes that what fails at one value fails at all larger ones. ``confirm`` looks at the values just below
    the limit as well; if one of them fails, the limit is below it.

    Attributes:
        config: grid and checks.
        outcomes: whether each value that was tried was survived.
        unknown: why the limit cannot be found; None where it can.
    """

    config: SearchConfig
    outcomes: dict[float, bool] = field(default_factory=dict)
    unknown: str | None = None

    @property
    def grid(self) -> list[float]:
        """All values, increasing."""
        steps = int((self.config.highest - self.config.lowest) / self.config.step + 1e-9)
        return [float(np.round(self.config.lowest + k * self.config.step, 9)) for k in range(steps + 1)]

    def record(self, value: float, survived: bool) -> None:
        """Take in the outcome of a value."""
        self.outcomes[value] = survived

    def give_up(self, reason: str) -> None:
        """End the search: a value could not be tried."""
        self.unknown = reason

    def next_value(self) -> float | None:
        """Return the value to try next; None when the search is over."""
        if self.unknown:
            return None
        grid = self.grid
        below, above = self._bracket(grid)
        if above - below > 1:
            return grid[(below + above) // 2]
        return next((value for value in reversed(self._checks(below)) if value not in self.outcomes), None)

    @property
    def limit(self) -> float | None:
        """The largest value below which no failure is known; None if the lowest one failed, or if unknown."""
        below, _ = self._bracket(self.grid)
        return self.grid[below] if below >= 0 and not self.unknown else None

    @property
    def monotone(self) -> bool | None:
        """Whether no value was survived above one that was not; None if no value below the limit was to tell."""
        outcomes = [self.outcomes[value] for value in sorted(self.outcomes)]
        if outcomes != sorted(outcomes, reverse=True):
            return False
        below, _ = self._bracket(self.grid)
        return True if self._checks(below) and not self.unknown else None

    def _checks(self, below: int) -> list[float]:
        """Return the values just below the limit, which stands at the position ``below``, that have to be survived."""
        return self.grid[max(0, below - self.config.confirm) : max(below, 0)]

    def _bracket(self, grid: list[float]) -> tuple[int, int]:
        """Return the positions of the largest value known to be survived and of the smallest that was not."""
        failed = [k for k, value in enumerate(grid) if self.outcomes.get(value) is False]
        above = min(failed, default=len(grid))
        survived = [k for k, value in enumerate(grid[:above]) if self.outcomes.get(value)]
        return max(survived, default=-1), above
