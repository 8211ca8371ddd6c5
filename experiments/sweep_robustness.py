"""Kill workers of a sweep at random, then the sweep itself, go on, and compare with a sweep that nobody disturbed.

    python experiments/sweep_robustness.py [--trials 500] [--kills 5] [--folder results/sweep_robustness]

Every trial stands for a second from a start of its own. Exit code 1 if a row is missing or differs.
"""

import argparse
import random
import subprocess
import sys
import time
from pathlib import Path

from quadlab.analysis.collect import collect_trials
from quadlab.sweeps.limits import PoolConfig
from quadlab.sweeps.terminal import PlainSweep
from quadlab.sweeps.trial_pool import SweepTrial, run_trials
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions

STANDING = ("gait=stand", "command=in_place", "scenario=perturbed", "duration_s=1")
WORKERS = 2
RANDOM_SEED = 1


def sweep(folder: Path, count: int) -> int:
    """Run the sweep in this process and return the number of trials without a result."""
    config = compose_trial(STANDING)
    trials = [SweepTrial(f"seed={seed}", config.model_copy(update={"seed": seed})) for seed in range(count)]
    options = RunOptions(force=False, results_dir=str(folder))
    pool = PoolConfig(workers=WORKERS, memory_limit_gib=4.0, time_limit_s=120.0)
    outcomes = list(run_trials(trials, options, pool, PlainSweep(sys.stdout)))
    return sum(outcome.job.result is None for outcome in outcomes)


def start_sweep(folder: Path, count: int) -> "subprocess.Popen[bytes]":
    """Start the sweep in a process of its own."""
    return subprocess.Popen([sys.executable, __file__, "--folder", str(folder), "--trials", str(count), "--only-sweep"])


def children(pid: int) -> list[int]:
    """Return the processes that ``pid`` started and that live."""
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def finished(folder: Path) -> int:
    """Return the number of trials with a result."""
    return len(list(folder.glob("*/*/result.json")))


def disturb(folder: Path, count: int, kills: int) -> int:
    """Run the sweep, kill ``kills`` workers at random moments of its first half, then the sweep itself.

    Returns:
        How many workers were killed: fewer if the sweep was over before.
    """
    draw = random.Random(RANDOM_SEED)
    moments = sorted(draw.randrange(1, max(2, count // 2)) for _ in range(kills))
    process = start_sweep(folder, count)
    killed = 0
    while process.poll() is None and killed < kills:
        workers = [worker for server in children(process.pid) for worker in children(server)]
        if workers and finished(folder) >= moments[killed]:
            done = subprocess.run(["kill", "-KILL", str(draw.choice(workers))], check=False, capture_output=True)
            killed += done.returncode == 0  # it may have ended on its own in between
        time.sleep(0.2)
    while process.poll() is None and finished(folder) < 0.6 * count:
        time.sleep(0.2)
    process.kill()
    process.wait()
    sys.stdout.write(f"killed {killed} workers, then the sweep after {finished(folder)} of {count} results\n")
    return killed


def compare(undisturbed: Path, disturbed: Path, count: int) -> list[str]:
    """Return one line for each way in which the two folders differ."""
    expected, found = collect_trials(undisturbed), collect_trials(disturbed)
    problems = [f"{len(table)} rows instead of {count}" for table in (expected, found) if len(table) != count]
    missing = expected.index.symmetric_difference(found.index)
    problems += [f"{name}: in one of the two only" for name in missing]
    both = expected.index.intersection(found.index)
    for column in ("status", "state_sha256", "com_error_rms_mm", "distance_m"):
        differs = (expected.loc[both, column] != found.loc[both, column]).fillna(value=False)
        problems += [f"{name}: {column} differs" for name in both[differs.to_numpy(bool)]]
    return problems


def main() -> int:
    """Run both sweeps, compare them and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=500)
    parser.add_argument("--kills", type=int, default=5)
    parser.add_argument("--folder", type=Path, default=Path("results/sweep_robustness"))
    parser.add_argument("--only-sweep", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.only_sweep:
        return int(sweep(options.folder, options.trials) > 0)
    undisturbed, disturbed = options.folder / "undisturbed", options.folder / "disturbed"
    if undisturbed.exists() or disturbed.exists():
        parser.error(f"--folder: {options.folder} has trials from before, which would not be run again")
    killed = disturb(disturbed, options.trials, options.kills)
    codes = [start_sweep(folder, options.trials).wait() for folder in (disturbed, undisturbed)]
    problems = [f"a sweep ended with exit code {code}" for code in codes if code]
    problems += [f"{killed} workers were killed instead of {options.kills}"] * (killed < options.kills)
    problems += compare(undisturbed, disturbed, options.trials)
    sys.stdout.write("".join(f"{problem}\n" for problem in problems))
    sys.stdout.write(f"{options.trials} rows, {len(problems)} differences\n")
    return int(bool(problems))


if __name__ == "__main__":
    sys.exit(main())
