"""What can be wrong with a study in itself, before any of its jobs is looked at."""

from collections.abc import Iterator, Mapping, Sequence

from quadlab.studies.condition import Condition
from quadlab.studies.config import Level, StudyConfig
from quadlab.trials.problems import suggestion

PARTS = frozenset({"robot", "gait", "planner", "controller", "estimator", "scenario", "seed"})
"""What the row of a trial says of itself: a report may be by these too."""


def study_problems(study: StudyConfig, found: Sequence[Condition]) -> Iterator[str]:
    """Yield one line for each unknown factor that is named, and for each trace or plan of no or several jobs.

    Args:
        study: as in its file.
        found: all its conditions.
    """
    factors = {name for condition in found for name in condition.levels}
    searched = {condition.search.label for condition in found if condition.search}
    yield from _unknown("report_by", [name for name in study.report_by if name not in PARTS], factors | searched)
    picks = {f"trace '{trace.name}'": trace.where for trace in study.traces}
    picks |= {f"plan '{name}'": where for name, where in study.plans.items()}
    for what, where in picks.items():
        unknown = list(_unknown(what, where, factors | searched))
        yield from unknown or _not_one(what, {k: v for k, v in where.items() if k in factors}, found)


def _unknown(what: str, names: Sequence[str] | Mapping[str, Level], known: set[str]) -> Iterator[str]:
    return (f"{what}: unknown factor '{name}'; {suggestion(name, known)}" for name in names if name not in known)


def _not_one(what: str, where: Mapping[str, Level], found: Sequence[Condition]) -> Iterator[str]:
    """Yield a line unless one condition alone has the levels of ``where``."""
    picked = {condition.identifier for condition in found if condition.matches(where)}
    if len(picked) != 1:
        levels = ", ".join(f"{name}: {level}" for name, level in where.items()) or "no factor"
        yield f"{what}: {len(picked) or 'no'} jobs have {levels}; expected one"
