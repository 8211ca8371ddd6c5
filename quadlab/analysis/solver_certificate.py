"""How often each method solves hierarchies of closed-loop trials and random ones: verdicts of the certificate."""

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd

from quadlab.controllers.hierarchy import Level
from quadlab.controllers.hierarchy.random_hierarchy import DIMENSION, random_hierarchy
from quadlab.controllers.solver_opinions import METHODS, QUICK, Opinion, change_by_lower_levels, opinions
from quadlab.geometry.rotations import Array
from quadlab.trials.compose import compose_trial
from quadlab.trials.recorded_hierarchies import record_hierarchies

CERTIFIED = 1e-6
"""A smaller remainder counts as optimal."""
WRONG = 1e-3
"""A larger remainder is no inaccuracy of an iterative method any more."""


def judge_trial(trial: str, overrides: tuple[str, ...], stride: int, cascade_stride: int) -> list[dict[str, object]]:
    """Run a trial, let the methods solve hierarchies of it, and return one row a method.

    Args:
        trial: name for the rows.
        overrides: of the trial.
        stride: every so many ticks a hierarchy is judged.
        cascade_stride: of those hierarchies, every so manieth is also given to the cascades.
    """
    found: list[Opinion] = []
    changes: list[float] = []

    def judge(levels: Sequence[Level], start: Array) -> None:
        found.extend(opinions(levels, start, METHODS if len(changes) % cascade_stride == 0 else QUICK))
        changes.append(change_by_lower_levels(levels, start))

    config = compose_trial(list(overrides))
    ending = record_hierarchies(config, stride, judge)
    return _verdicts({"trial": trial, "controller": config.controller.name, "ending": ending}, found, changes)


def judge_random(name: str, seeds: Sequence[int], cascade_stride: int) -> list[dict[str, object]]:
    """Let the methods solve random hierarchies and return one row a method.

    Args:
        name: for the rows.
        seeds: of the hierarchies.
        cascade_stride: every so manieth is also given to the cascades.
    """
    found: list[Opinion] = []
    changes: list[float] = []
    for number, seed in enumerate(seeds):
        levels, start = random_hierarchy(seed), np.zeros(DIMENSION)
        found.extend(opinions(levels, start, METHODS if number % cascade_stride == 0 else QUICK))
        changes.append(change_by_lower_levels(levels, start))
    return _verdicts({"trial": name, "controller": None, "ending": "-"}, found, changes)


def _verdicts(common: dict[str, object], found: Sequence[Opinion], changes: Sequence[float]) -> list[dict[str, object]]:
    table = pd.DataFrame([asdict(opinion) for opinion in found])
    return [
        common | count_verdicts(method, table[table["method"] == method]) | {"change_by_lower_max": max(changes)}
        for method in METHODS
    ]


def count_verdicts(method: str, table: pd.DataFrame) -> dict[str, object]:
    """Return the counts of one method.

    Args:
        method: its name.
        table: one row a hierarchy with the columns of ``Opinion``.

    Returns:
        states; failed: the method says so itself; uncertified: it claims success and the remainder is not below
        ``CERTIFIED``; wrong: it claims success and the remainder is above ``WRONG`` or a level has other slacks;
        remainder_max and remainder_median of the claimed successes; time_us_median.
    """
    claimed = table[table["solved"].astype(bool)]
    remainder = claimed["remainder"]
    return {
        "method": method,
        "states": len(table),
        "failed": len(table) - len(claimed),
        "uncertified": int((~(remainder < CERTIFIED)).sum()),
        "wrong": int(((remainder > WRONG) | claimed["differs"].astype(bool)).sum()),
        "remainder_max": float(remainder.max()) if len(claimed) else float("nan"),
        "remainder_median": float(remainder.median()) if len(claimed) else float("nan"),
        "time_us_median": float(table["time_us"].median()),
    }


def report(table: pd.DataFrame, source: str) -> str:
    """Return the report of a table of ``judge_trial`` or ``judge_random`` rows: all together, then trial by trial.

    Args:
        table: with the columns of those.
        source: of the hierarchies, for the title.
    """
    total = int(table.loc[table["method"] == METHODS[0], "states"].sum())
    lines = [
        f"# Certificates of solutions: {source}",
        "",
        f"{total} hierarchies; cascades, which are slow, are given a part of them. Failed: the method",
        "says so itself. Uncertified: it claims success,",
        f"but the remainder of the optimality conditions is not below {CERTIFIED:.0e}. Wrong: it claims success, but",
        f"the remainder is above {WRONG:.0e} or a level has other slacks.",
        "",
        "| method | states | failed | uncertified | wrong | largest remainder | median remainder |",
        "|---|--:|--:|--:|--:|--:|--:|",
    ]
    for method in METHODS:
        rows = table[table["method"] == method]
        counts = " | ".join(str(int(rows[column].sum())) for column in ("states", "failed", "uncertified", "wrong"))
        median = rows["remainder_median"].median()
        lines.append(f"| {method} | {counts} | {rows['remainder_max'].max():.1e} | {median:.1e} |")
    change = table["change_by_lower_max"].max()
    lines += ["", f"Lower levels change the slacks of higher ones by at most {change:.1e} (relative to 1 + norm).", ""]
    return "\n".join([*lines, *_by_trial(table)]) + "\n"


def _by_trial(table: pd.DataFrame) -> list[str]:
    lines = ["Failed + wrong by trial:", "", f"| trial | ending | states | {' | '.join(METHODS)} |"]
    lines.append(f"|---|---|{'--:|' * (1 + len(METHODS))}")
    for trial, rows in table.groupby("trial", sort=False):
        first = rows.iloc[0]
        if pd.isna(first["states"]):  # the program failed; the reason stands in its place
            lines.append(f"| {trial} | {first['ending']} | 0 |{' |' * len(METHODS)}")
            continue
        pairs = rows.set_index("method").loc[list(METHODS), ["failed", "wrong"]].to_numpy(int)
        counts = [f"{failed} + {wrong}" for failed, wrong in pairs]
        lines.append(f"| {trial} | {first['ending']} | {first['states']:.0f} | {' | '.join(counts)} |")
    return lines
