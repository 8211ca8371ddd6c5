"""Several trials as one piece of work for a machine elsewhere."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from quadlab.errors import LogError
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.terminal import PlainSweep
from quadlab.sweeps.trial_pool import SweepOutcome, SweepTrial, run_trials
from quadlab.trials.config import RunOptions
from quadlab.trials.job import finished_before, record_failure


@dataclass(frozen=True)
class Cell:
    """Some trials of a sweep.

    Attributes:
        trials: of the cell.
        options: how to run each of them, not forced: a result that is there is new, see ``without_old_results``.
        pool: how to run all of them, on the machine that gets the cell.
    """

    trials: tuple[SweepTrial, ...]
    options: RunOptions
    pool: PoolConfig

    def run(self) -> list[SweepOutcome]:
        """Run the trials here, print a line for each, and return what came of them."""
        return list(run_trials(self.trials, self.options, self.pool, PlainSweep(sys.stdout)))

    def lost(self, reason: str) -> list[SweepOutcome]:
        """Return what is there of a cell whose machine ended before it had answered.

        Args:
            reason: one line; it becomes ``error.json`` of the trials that have no result.
        """
        return [self._found(trial, reason) for trial in self.trials]

    def _found(self, trial: SweepTrial, reason: str) -> SweepOutcome:
        try:
            job = finished_before(trial.config, self.options)
        except LogError as error:
            job = record_failure(trial.config, self.options, "died", f"{reason}; {error}", "")
        return SweepOutcome(trial, job or record_failure(trial.config, self.options, "died", reason, ""))


def cells(trials: Sequence[SweepTrial], size: int, options: RunOptions, pool: PoolConfig) -> list[Cell]:
    """Return ``trials`` in cells of ``size``, the last one perhaps smaller."""
    return [Cell(tuple(trials[i : i + size]), options, pool) for i in range(0, len(trials), size)]
