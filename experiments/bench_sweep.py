"""How much a second worker gives, what a sweep costs beside its trials, and whether memory grows.

    python experiments/bench_sweep.py [--trials 12] [--duration 10] [--repeats 3] [--many 1000]

The same trials run in a sweep with one worker and in one with two, in turns, each time beside a plain loop that does
nothing but compute, in one process and in two: what the machine itself gives is the most that a sweep can give. Then
each trial runs in this process and in a worker of its own, one after the other. Medians of ratios, since the speed of
shared machines changes from second to second. At last short trials run in this process, and the memory that it holds
is printed along the way.
"""

import argparse
import io
import os
import statistics
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from threadpoolctl import threadpool_limits

from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.terminal import PlainSweep
from quadlab.sweeps.trial_pool import SweepTrial, run_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.job import run_job
from quadlab.trials.progress import SilentProgress

_MIBIBYTE = 2**20
_PAGE_BYTES = 4096
_LOOP = 20_000_000
"""Rounds of the plain loop: about a second."""
_LOOPS = 3
"""Measurements of the plain loop before each turn."""


class SweepTime(NamedTuple):
    """Times of a sweep in [s].

    Attributes:
        start: until the first worker begins.
        rest: from there to the end.
        workers: lives of all workers together.
    """

    start: float
    rest: float
    workers: float


def trot(duration_s: float, seed: int) -> TrialConfig:
    """Return one trial of many that differ in where they start."""
    return compose_trial(["gait=trot", "scenario=perturbed", f"duration_s={duration_s:g}", f"seed={seed}"])


def seconds_in_this_process(trial: TrialConfig) -> float:
    """Run ``trial`` as a worker does and return how long that takes in [s]."""
    with TemporaryDirectory() as folder:
        began = time.perf_counter()
        run_job(trial, RunOptions(force=False, results_dir=folder), SilentProgress())
        return time.perf_counter() - began


def sweep(trials: list[TrialConfig], workers: int) -> SweepTime:
    """Run ``trials`` with so many workers."""
    named = [SweepTrial(f"seed={trial.seed}", trial) for trial in trials]
    pool = PoolConfig(workers=workers, memory_limit_gib=4.0, time_limit_s=600.0)
    lives: list[float] = []
    begins: list[float] = []
    with TemporaryDirectory() as folder:
        began = time.perf_counter()
        options = RunOptions(force=False, results_dir=folder)
        for outcome in run_trials(named, options, pool, PlainSweep(io.StringIO())):
            assert outcome.job.result is not None, outcome.job.failure
            begins.append(time.perf_counter() - outcome.wall_s)
            lives.append(outcome.wall_s)
        ended = time.perf_counter()
    return SweepTime(min(begins) - began, ended - min(begins), sum(lives))


def plain_loop(processes: int) -> float:
    """Return how long ``processes`` processes take that only compute, side by side, in [s]."""
    began = time.perf_counter()
    children = []
    for _ in range(processes):
        child = os.fork()
        if child == 0:
            total = 0.0
            for number in range(_LOOP):
                total += 0.5 * number
            os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)
    return time.perf_counter() - began


def resident_mib() -> float:
    """Return the memory that this process holds in [MiB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * _PAGE_BYTES / _MIBIBYTE


def print_gain_of_second_worker(trials: list[TrialConfig], repeats: int) -> None:
    """Print how much more two workers do than one, and how much more two plain processes."""
    machine, whole, running, between, starts = [], [], [], [], []
    for _ in range(repeats):
        machine += [2.0 * plain_loop(1) / plain_loop(2) for _ in range(_LOOPS)]
        one, two = sweep(trials, 1), sweep(trials, 2)
        whole.append((one.start + one.rest) / (two.start + two.rest))
        running.append(one.rest / two.rest)
        between.append(one.rest / one.workers - 1.0)
        starts += [one.start, two.start]
        sys.stdout.write(
            f"  one worker {one.rest:.1f} s, two workers {two.rest:.1f} s, after {one.start:.1f} s of start\n"
        )
        sys.stdout.flush()
    sys.stdout.write(
        f"two workers do {statistics.median(running):.2f} times the work of one, "
        f"{statistics.median(whole):.2f} with the {statistics.median(starts):.1f} s that a sweep takes to start\n"
        f"two plain processes do {statistics.median(machine):.2f} times the work of one "
        f"({min(machine):.2f} to {max(machine):.2f})\n"
        f"between its trials a sweep takes {100.0 * statistics.median(between):.1f} % of their time\n"
    )


def print_cost_of_a_worker(trials: list[TrialConfig], repeats: int) -> None:
    """Print how much longer a trial takes in a worker than in this process."""
    ratios = [
        sweep([trial], 1).workers / seconds_in_this_process(trial) - 1.0 for _ in range(repeats) for trial in trials
    ]
    low, middle, high = (100.0 * value for value in statistics.quantiles(ratios))
    sys.stdout.write(
        f"a trial takes {middle:.1f} % longer in a worker than alone "
        f"(quartiles {low:.1f} to {high:.1f}, {len(ratios)} pairs)\n"
    )


def print_memory(trials: int) -> None:
    """Print the memory of this process while it runs many trials."""
    for count in range(trials):
        seconds_in_this_process(trot(2.0, count))
        if (count + 1) % max(1, trials // 10) == 0:
            sys.stdout.write(f"  {resident_mib():.0f} MiB after {count + 1} trials in one process\n")
            sys.stdout.flush()


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=12)
    parser.add_argument("--duration", type=float, default=10.0, help="of the trials in [s]")
    parser.add_argument("--repeats", type=int, default=3, help="0 leaves the sweeps out")
    parser.add_argument("--many", type=int, default=1000, help="trials of 2 s in one process; 0 leaves that out")
    arguments = parser.parse_args()
    trials = [trot(arguments.duration, seed) for seed in range(arguments.trials)]
    with threadpool_limits(1):
        seconds_in_this_process(trials[0])  # loads and compiles everything
        if arguments.repeats:
            print_gain_of_second_worker(trials, arguments.repeats)
            print_cost_of_a_worker(trials, arguments.repeats)
        print_memory(arguments.many)
    return 0


if __name__ == "__main__":
    sys.exit(main())
