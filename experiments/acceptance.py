"""Every acceptance trial in full: gaits, robots and seeds; table and report go to results/acceptance/.

    python experiments/acceptance.py [--jobs 2] [--seeds 10]

Trials whose result is there already are not run again. Exit code 1 if a trial did not complete.
"""

import argparse
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

import pandas as pd

from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.job import run_job
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import TrialStatus

FOLDER = Path("results/acceptance")
ROBOTS = ("anymal_b", "hyq")
GAITS = ("walk", "trot")
DURATION_S = 20.0
COLUMNS = [
    "robot",
    "gait",
    "scenario",
    "seed",
    "status",
    "survived_s",
    "distance_m",
    "com_error_rms_mm",
    "com_error_max_mm",
    "base_height_rms_mm",
    "roll_pitch_rms_deg",
    "foot_slip_max_mm",
    "torque_max_nm",
    "control_fallbacks",
    "state_sha256",
    "status_reason",
]


def trials(seeds: int) -> Iterator[list[str]]:
    """Yield the overrides of every acceptance trial."""
    for robot, gait, seed in product(ROBOTS, GAITS, range(seeds)):
        yield [
            f"robot={robot}",
            f"gait={gait}",
            "scenario=perturbed",
            f"seed={seed}",
            f"duration_s={DURATION_S:g}",
            "tag=trials",
        ]


def run(overrides: list[str]) -> dict[str, object]:
    """Run one trial and return its row."""
    options = RunOptions(force=False, results_dir=str(FOLDER))
    outcome = run_job(compose_trial(overrides), options, SilentProgress())
    if outcome.result is None:
        return {"status": TrialStatus.ERROR.value, "status_reason": outcome.failure, "overrides": " ".join(overrides)}
    return outcome.result.model_dump(mode="json")


def report(table: pd.DataFrame) -> str:
    """Return the table of README.md: one row a robot and gait, the worst seed in every column."""
    lines = [
        "| robot | gait | completed | CoM rms / max [mm] | height rms [mm] | roll, pitch rms [deg] | torque [N m] |",
        "|---|---|--:|--:|--:|--:|--:|",
    ]
    for (robot, gait), rows in table.groupby(["robot", "gait"], sort=False):
        completed = int((rows["status"] == TrialStatus.COMPLETED).sum())
        worst = rows.max(numeric_only=True)
        lines.append(
            f"| {robot} | {gait} | {completed} of {len(rows)} "
            f"| {worst['com_error_rms_mm']:.1f} / {worst['com_error_max_mm']:.1f} | {worst['base_height_rms_mm']:.1f} "
            f"| {worst['roll_pitch_rms_deg']:.2f} | {worst['torque_max_nm']:.0f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    """Run all trials, write the table and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2, help="trials at a time")
    parser.add_argument("--seeds", type=int, default=10, help="initial perturbations per robot and gait")
    arguments = parser.parse_args()
    rows = []
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(run, trials(arguments.seeds)):
            rows.append(row)
            name = " ".join(str(row.get(key)) for key in ("robot", "gait", "seed"))
            sys.stdout.write(f"{name}: {row['status']}, {row['status_reason']}\n")
            sys.stdout.flush()
    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    table.to_csv(FOLDER / "table.csv", index=False, float_format="%.4g")
    (FOLDER / "report.md").write_text(report(table), encoding="utf-8")
    completed = int((table["status"] == TrialStatus.COMPLETED).sum())
    sys.stdout.write(f"{completed} of {len(table)} trials completed; table in {FOLDER / 'table.csv'}\n")
    return 0 if completed == len(table) else 1


if __name__ == "__main__":
    sys.exit(main())
