"""What the process that workers are forked from does once, so that no worker has to: imports and machine code."""

import tempfile
from collections.abc import Iterable, Sequence
from contextlib import suppress

from quadlab.errors import QuadlabError
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.job import run_job
from quadlab.trials.manifest import note_code
from quadlab.trials.progress import SilentProgress

_STANDING = ("gait=stand", "gait.cycles.0.stride_duration_s=0.1", "command=in_place", "scenario=flat", "duration_s=0.1")
_TAKEN_FROM_STANDING = ("gait", "command", "scenario", "duration_s")


def import_trials() -> None:
    """Note of which code the process is: what a trial needs was imported with this module."""
    note_code()


def warm_up(trials: Sequence[TrialConfig]) -> None:
    """Run ``trials`` without keeping anything but what they loaded; what is wrong with them is not reported here."""
    note_code()
    with tempfile.TemporaryDirectory(prefix="quadlab-warm-up-") as folder:
        options = RunOptions(force=True, results_dir=folder)
        for config in trials:
            with suppress(QuadlabError):  # the trial itself will say it
                run_job(config, options, SilentProgress())


def warm_up_trials(trials: Iterable[TrialConfig]) -> list[TrialConfig]:
    """Return a tenth of a second of standing for each combination of planner, controller and estimator."""
    standing = compose_trial(_STANDING)
    changes = {name: getattr(standing, name) for name in _TAKEN_FROM_STANDING}
    first = {(trial.planner.kind, trial.controller.kind, trial.estimator.kind): trial for trial in reversed([*trials])}
    return [trial.model_copy(update=changes) for trial in first.values()]
