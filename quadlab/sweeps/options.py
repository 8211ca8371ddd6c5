"""How to run a sweep; none of it changes what happens in a trial."""

import re
from collections.abc import Sequence
from typing import Any, Self

from omegaconf import DictConfig
from pydantic import model_validator

from quadlab.configuration import StrictModel
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.slurm import SlurmConfig
from quadlab.sweeps.trial_pool import SweepTrial
from quadlab.trials.compose import sweep_values, validated
from quadlab.trials.config import TrialConfig
from quadlab.trials.identity import trial_id


class Shard(StrictModel):
    """One of several equal parts of a sweep, for machines that share nothing but the command line.

    Attributes:
        index: of this part, 0 to ``count`` - 1.
        count: number of parts.
    """

    index: int
    count: int

    @model_validator(mode="before")
    @classmethod
    def _from_text(cls, value: Any) -> Any:
        match = re.fullmatch(r"(\d+)/(\d+)", str(value))
        if not match:
            raise ValueError("expected i/n such as 0/4")
        return {"index": int(match[1]), "count": int(match[2])}

    @model_validator(mode="after")
    def _in_range(self) -> Self:
        if not 0 <= self.index < self.count:
            raise ValueError(f"{self.index}/{self.count} does not exist; the first of n is 0/n")
        return self

    def of(self, trials: Sequence[SweepTrial]) -> list[SweepTrial]:
        """Return this part of different ``trials``, in their order: together the parts have each of them once.

        They are dealt out in the order of their ids, so that no part gets all trials with one value of a factor.
        """
        order = sorted(range(len(trials)), key=lambda number: _order(trials[number].config))
        return [trials[number] for number in sorted(order[self.index :: self.count])]


def _order(config: TrialConfig) -> tuple[str, str]:
    return trial_id(config), config.tag


class SweepOptions(StrictModel):
    """How to run a sweep.

    Attributes:
        pool: limits of the processes.
        slurm: how to give it to SLURM; null runs it here.
        shard: the part that is run; null runs all of it.
    """

    pool: PoolConfig
    slurm: SlurmConfig | None = None
    shard: Shard | None


def sweep_options(document: DictConfig) -> SweepOptions:
    """Return what a composed document says about running a sweep.

    Raises:
        ConfigurationError: with one line for each mistake.
    """
    return validated(SweepOptions, sweep_values(document))
