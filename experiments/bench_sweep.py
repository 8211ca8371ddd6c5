"""How much a second worker gives, what a sweep costs beside its trials, and whether memory grows.

    python experiments/bench_sweep.py [--trials 8] [--duration 10] [--repeats 3] [--many 1000]

The same trials run in this process, in a sweep with one worker and in a sweep with two, in turns; medians over the
repeats of ratios within one turn. Two trials alone tell what a sweep takes to start; what it adds to each trial is seen
in the others. Then short trials run one after the other in this process, and the memory that it
holds is printed along the way.
"""

import argparse
import io
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from threadpoolctl import threadpool_limits

from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.terminal import PlainSweep
from quadlab.sweeps.trial_pool import SweepTrial, run_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.job import run_job
from quadlab.trials.progress import SilentProgress

_FEW = 2
_MIBIBYTE = 2**20
_PAGE_BYTES = 4096


def trot(duration_s: float, seed: int) -> TrialConfig:
    """Return one trial of many that differ in where they start."""
    return compose_trial(["gait=trot", "scenario=perturbed", f"duration_s={duration_s:g}", f"seed={seed}"])


def in_this_process(trials: list[TrialConfig], folder: Path) -> None:
    """Run ``trials`` as a worker does, one after the other."""
    options = RunOptions(force=False, results_dir=str(folder))
    for trial in trials:
        run_job(trial, options, SilentProgress())


def in_a_sweep(workers: int) -> Callable[[list[TrialConfig], Path], None]:
    """Return a function that runs trials with ``workers`` workers."""

    def sweep(trials: list[TrialConfig], folder: Path) -> None:
        named = [SweepTrial(f"seed={trial.seed}", trial) for trial in trials]
        options = RunOptions(force=False, results_dir=str(folder))
        pool = PoolConfig(workers=workers, memory_limit_gib=4.0, time_limit_s=600.0)
        outcomes = list(run_trials(named, options, pool, PlainSweep(io.StringIO())))
        assert all(outcome.job.result is not None for outcome in outcomes)

    return sweep


def seconds(run: Callable[[list[TrialConfig], Path], None], trials: list[TrialConfig]) -> float:
    """Return how long ``run`` takes in [s]."""
    with TemporaryDirectory() as folder:
        began = time.perf_counter()
        run(trials, Path(folder))
        return time.perf_counter() - began


def resident_mib() -> float:
    """Return the memory that this process holds in [MiB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * _PAGE_BYTES / _MIBIBYTE


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=8)
    parser.add_argument("--duration", type=float, default=10.0, help="of the trials in [s]")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--many", type=int, default=1000, help="trials of 2 s in one process; 0 leaves that out")
    arguments = parser.parse_args()
    trials = [trot(arguments.duration, seed) for seed in range(arguments.trials)]
    with threadpool_limits(1):
        seconds(in_this_process, trials[:1])  # loads and compiles everything
        gains, starts, overheads = [], [], []
        for _ in range(arguments.repeats):
            alone, one, two = (seconds(run, trials) for run in (in_this_process, in_a_sweep(1), in_a_sweep(2)))
            few_alone, few_in_sweep = (seconds(run, trials[:_FEW]) for run in (in_this_process, in_a_sweep(1)))
            gains.append(one / two)
            starts.append(few_in_sweep - few_alone)
            overheads.append((one - few_in_sweep) / (alone - few_alone) - 1.0)
            sys.stdout.write(f"  in one process {alone:.1f} s, one worker {one:.1f} s, two workers {two:.1f} s\n")
            sys.stdout.flush()
        sys.stdout.write(f"two workers do {statistics.median(gains):.2f} times the work of one\n")
        sys.stdout.write(f"a sweep takes {statistics.median(starts):.1f} s to start with {_FEW} trials\n")
        sys.stdout.write(f"every further trial takes {100.0 * statistics.median(overheads):.1f} % longer than alone\n")
        for count in range(arguments.many):
            seconds(in_this_process, [trot(2.0, count)])
            if (count + 1) % max(1, arguments.many // 10) == 0:
                sys.stdout.write(f"  {resident_mib():.0f} MiB after {count + 1} trials in one process\n")
                sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
