"""How to run a sweep; none of it changes what happens in a trial."""

import re
from collections.abc import Sequence
from typing import Any, Self, TypeVar

from omegaconf import DictConfig
from pydantic import model_validator

from quadlab.configuration import StrictModel
from quadlab.errors import ConfigurationError
from quadlab.sweeps.limits import PoolConfig
from quadlab.trials.compose import sweep_values, validated

_Item = TypeVar("_Item")


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
            raise ConfigurationError(f"expected i/n such as 0/4, got '{value}'")
        return {"index": int(match[1]), "count": int(match[2])}

    @model_validator(mode="after")
    def _in_range(self) -> Self:
        if not 0 <= self.index < self.count:
            raise ConfigurationError(
                f"{self.index}/{self.count} does not exist; the parts of {self.count} begin with 0"
            )
        return self

    def of(self, items: Sequence[_Item]) -> list[_Item]:
        """Return every ``count``-th item: together the shards have each item exactly once."""
        return list(items[self.index :: self.count])


class SweepOptions(StrictModel):
    """How to run a sweep.

    Attributes:
        pool: limits of the processes.
        shard: the part that is run here; null runs all of it.
    """

    pool: PoolConfig
    shard: Shard | None


def sweep_options(document: DictConfig) -> SweepOptions:
    """Return what a composed document says about running a sweep.

    Raises:
        ConfigurationError: with one line for each mistake.
    """
    return validated(SweepOptions, sweep_values(document))
