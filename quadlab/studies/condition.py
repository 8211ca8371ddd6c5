"""The single jobs of a study: one combination of levels each."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from quadlab.studies.config import BlockConfig, Factor, Level, SearchConfig, StudyConfig

ID_LENGTH = 16  # hexadecimal digits


@dataclass(frozen=True)
class Condition:
    """One combination of levels.

    Attributes:
        levels: of each factor, by its name.
        overrides: of ``conf/trial.yaml`` that make it.
        search: what is searched for in it, if anything.
    """

    levels: dict[str, Level]
    overrides: tuple[str, ...]
    search: SearchConfig | None = None

    @property
    def identifier(self) -> str:
        """Name of its files: equal overrides have equal names."""
        return hashlib.sha256(json.dumps(self.overrides).encode()).hexdigest()[:ID_LENGTH]

    def probe(self, value: float) -> "Condition":
        """Return the job that tries a grid value of the search."""
        if self.search is None:
            raise ValueError("nothing is searched for in this condition")
        override = f"{self.search.key}={self.search.factor * value:.10g}"
        return Condition({**self.levels, self.search.label: value}, (*self.overrides, override))

    def matches(self, where: Mapping[str, Level]) -> bool:
        """Whether its levels are those of ``where``, as far as these go."""
        return all(self.levels.get(name) == level for name, level in where.items())


def conditions(study: StudyConfig) -> list[Condition]:
    """Return all combinations of a study, block by block."""
    return [condition for block in study.blocks for condition in _of_block(block)]


def _of_block(block: BlockConfig) -> Iterator[Condition]:
    choices = [list(_levels(name, factor)) for name, factor in block.factors.items()]
    for combination in product(*choices):
        levels = {name: level for name, (level, _) in zip(block.factors, combination, strict=True)}
        changes = [change for _, overrides in combination for change in overrides]
        yield Condition(levels, (*block.overrides, *changes), block.search)


def _levels(name: str, factor: Factor) -> Iterator[tuple[Level, tuple[str, ...]]]:
    """Yield each level of a factor with its overrides."""
    if isinstance(factor, dict):
        yield from factor.items()
    else:
        yield from ((value, (f"{name}={value}",)) for value in factor)
