"""A sweep on the command line: the trials that ``-m gait=walk,trot seed=0,1,2`` asks for."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override

from quadlab.errors import ConfigurationError
from quadlab.paths import CONF_DIR
from quadlab.sweeps.options import SweepOptions, sweep_options
from quadlab.sweeps.progress import SilentSweep, SweepProgress
from quadlab.sweeps.trial_pool import SweepTrial
from quadlab.trials.compose import ROOT_NAME, split_document
from quadlab.trials.composer import Composer
from quadlab.trials.config import RunOptions
from quadlab.trials.override_problems import COMPOSITION_ERRORS, UNTYPED_COMPOSITION_ERRORS, composition_problem

TOLD_EVERY_S = 2.0  # [s] between two lines of progress

Choice = tuple[tuple[str, str], ...]
"""The values of one key: (key, override) pairs."""


@dataclass(frozen=True)
class SweepPoint:
    """One combination of a sweep.

    Attributes:
        name: the overrides that differ between the points, e.g. "gait=walk seed=0".
        overrides: all of them, none with several values.
    """

    name: str
    overrides: tuple[str, ...]


@dataclass(frozen=True)
class Sweep:
    """A sweep, checked completely.

    Attributes:
        trials: all of them, those of other shards included.
        run: how to run each trial.
        options: how to run all of them.
    """

    trials: tuple[SweepTrial, ...]
    run: RunOptions
    options: SweepOptions


def sweep_points(overrides: Sequence[str]) -> list[SweepPoint]:
    """Return all combinations of overrides such as ``seed=0,1,2``, the last one changing fastest.

    What an experiment file lists under ``hydra.sweeper.params`` is varied too.

    Args:
        overrides: as on the command line; of several for one key the last one counts.

    Raises:
        ConfigurationError: if one of them cannot be read.
    """
    try:
        with initialize_config_dir(version_base="1.3", config_dir=str(CONF_DIR)):
            parser = OverridesParser.create(GlobalHydra.instance().config_loader())
            given = parser.parse_overrides([*overrides])
            fixed = [item.input_line for item in given if not item.is_sweep_override()]
            document = compose(ROOT_NAME, overrides=fixed, return_hydra_config=True)
            listed = parser.parse_overrides([f"{k}={v}" for k, v in (document.hydra.sweeper.params or {}).items()])
            choices = {item.get_key_element(): _choice(item) for item in (*listed, *given)}
    except (*COMPOSITION_ERRORS, *UNTYPED_COMPOSITION_ERRORS) as error:
        raise ConfigurationError(composition_problem(error)) from error
    return [_point(combination, choices) for combination in product(*choices.values())]


def check_sweep(points: Sequence[SweepPoint], progress: SweepProgress | None = None) -> Sweep:
    """Return the sweep of all points, every trial validated: nothing runs if anything is wrong.

    Args:
        points: at least one.
        progress: told now and then how many were checked; silent by default.

    Raises:
        ConfigurationError: with one line for each different mistake.
    """
    trials: list[SweepTrial] = []
    options: list[tuple[RunOptions, SweepOptions]] = []
    problems: dict[str, None] = {}
    composer = Composer()
    for point in _told(points, progress or SilentSweep()):
        try:
            document = composer.compose(point.overrides)
            config, run = split_document(document)
            options.append((run, sweep_options(document)))
            trials.append(SweepTrial(point.name, config))
        except ConfigurationError as error:
            problems |= dict.fromkeys(str(error).splitlines())
    if any(other != options[0] for other in options):
        problems["force, results_dir, pool, slurm and shard are those of the whole sweep: give one value each"] = None
    if problems:
        raise ConfigurationError("\n".join(problems))
    return Sweep(tuple(trials), *options[0])


def _told(points: Sequence[SweepPoint], progress: SweepProgress) -> Iterator[SweepPoint]:
    """Yield all points and say now and then how many were taken."""
    told_s = time.monotonic()
    for number, point in enumerate(points):
        if time.monotonic() - told_s >= TOLD_EVERY_S:
            progress.notice(f"{number} of {len(points)} trials checked")
            told_s = time.monotonic()
        yield point


def _choice(override: Override) -> Choice:
    key = override.get_key_element()
    if not override.is_sweep_override():
        return ((key, override.input_line),)
    if not override.is_discrete_sweep():
        raise ConfigurationError(f"{override.input_line}: an interval has no list of values; write {key}=a,b,c")
    choice = tuple((key, f"{key}={value}") for value in override.sweep_string_iterator())
    if not choice:
        raise ConfigurationError(f"{override.input_line}: no values")
    return choice


def _point(combination: Sequence[tuple[str, str]], choices: dict[str, Choice]) -> SweepPoint:
    name = " ".join(override for key, override in combination if len(choices[key]) > 1)
    return SweepPoint(name or "the only trial", tuple(override for _, override in combination))
