"""Certificates of every solver on hierarchies of closed-loop trials, or random ones; to results/solver_certificate/.

    python experiments/solver_certificate.py [--jobs 2] [--stride 6] [--cascade-stride 10]
    python experiments/solver_certificate.py --random 10000 [--jobs 2] [--cascade-stride 10]

Walk, trot, pushed trot, a plank and a transition with the default controller and both papers' priorities, and the step
down of Bellicoso 2016. Failures are counted in the table; exit code 1 if a lexicographic one is not certified.
"""

import argparse
import sys
from itertools import product
from pathlib import Path

import pandas as pd

from quadlab.analysis.solver_certificate import judge_random, judge_trial, report
from quadlab.controllers.solver_opinions import LEXICOGRAPHIC
from quadlab.sweeps.job import Job, JobStatus
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.pool import run_pool

FOLDER = Path("results/solver_certificate")
CONTROLLERS = ("hierarchical", "gehring2017", "bellicoso2016")
MOTIONS = {
    "walk": ("gait=walk", "duration_s=12"),
    "trot": ("gait=trot", "duration_s=8"),
    "pushed trot": ("gait=trot", "scenario=push", "duration_s=8"),
    "plank": ("gait=trot", "scenario=plank", "duration_s=12"),
    "transition": ("gait=walk_to_trot", "duration_s=12"),
}
TRIALS = {
    f"{motion}, {controller}": (f"controller={controller}", *MOTIONS[motion])
    for motion, controller in product(MOTIONS, CONTROLLERS)
} | {"step down, bellicoso2016": ("experiment=bellicoso2016_step_down",)}


RANDOM_PART = 500
"""Random hierarchies of one job."""


def main() -> int:
    """Judge all hierarchies and write table and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2, help="trials at a time")
    parser.add_argument("--stride", type=int, default=6, help="every so many ticks one hierarchy is judged")
    parser.add_argument("--cascade-stride", type=int, default=10, help="every so manieth of them is given to cascades")
    parser.add_argument("--random", type=int, default=0, help="so many random hierarchies instead of trials")
    arguments = parser.parse_args()
    jobs = random_jobs(arguments) if arguments.random else trial_jobs(arguments)
    table = pd.DataFrame(judged_rows(jobs, arguments.jobs))
    name, source = ("random", "random") if arguments.random else ("table", "sampled from closed-loop trials")
    FOLDER.mkdir(parents=True, exist_ok=True)
    table.to_csv(FOLDER / f"{name}.csv", index=False, float_format="%.4g")
    text = report(table, source)
    (FOLDER / ("random.md" if arguments.random else "report.md")).write_text(text, encoding="utf-8")
    sys.stdout.write(text)
    ours = table[table["method"] == LEXICOGRAPHIC]
    return int(len(ours) < len(jobs) or bool(ours[["failed", "uncertified", "wrong"]].to_numpy().any()))


def trial_jobs(arguments: argparse.Namespace) -> list[Job]:
    """Return one job a trial."""
    strides = (arguments.stride, arguments.cascade_stride)
    return [Job(name, judge_trial, (name, overrides, *strides)) for name, overrides in TRIALS.items()]


def random_jobs(arguments: argparse.Namespace) -> list[Job]:
    """Return jobs of ``RANDOM_PART`` hierarchies each."""
    parts = [
        range(first, min(first + RANDOM_PART, arguments.random)) for first in range(0, arguments.random, RANDOM_PART)
    ]
    names = [f"random, {part.start} to {part.stop - 1}" for part in parts]
    return [
        Job(name, judge_random, (name, part, arguments.cascade_stride)) for name, part in zip(names, parts, strict=True)
    ]


def judged_rows(jobs: list[Job], workers: int) -> list[dict[str, object]]:
    """Return the rows of all jobs in their order; of one that broke, why."""
    pool = PoolConfig(workers=workers, memory_limit_gib=None, time_limit_s=None)
    rows: dict[int, list[dict[str, object]]] = {}
    for outcome in run_pool(jobs, pool):
        name = jobs[outcome.number].name
        judged = outcome.status is JobStatus.RETURNED
        rows[outcome.number] = outcome.value if judged else [{"trial": name, "ending": outcome.reason}]
        sys.stdout.write(f"{name}: {outcome.reason or 'judged'} ({outcome.wall_s:.0f} s)\n")
        sys.stdout.flush()
    return [row for number in sorted(rows) for row in rows[number]]


if __name__ == "__main__":
    sys.exit(main())
