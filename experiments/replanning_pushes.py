"""What replanning does to push recovery: ANYmal B trots and is pushed; goes to results/replanning_pushes/.

    python experiments/replanning_pushes.py [--jobs 2]

The clock of the simulation stands still while a planner works. Falls are rows; exit code 1 if a trial did not complete.
"""

import sys
from itertools import product

import pandas as pd
from trial_table import run_table

from quadlab.trials.result import TrialStatus

PERIODS = ("null", "0.2", "0.02")  # [s]; 0.02 is 50 Hz
DIRECTIONS = ("[1,0,0]", "[0,1,0]", "[0,-1,0]")
FORCES = (120.0, 200.0, 260.0)  # [N] for 0.15 s
STARTS = (2.5, 2.7)  # [s] at two phases of the stride
TRIALS = [
    (
        "scenario=push",
        f"scenario.pushes.0.direction={direction}",
        f"scenario.pushes.0.force_n={force:g}",
        f"scenario.pushes.0.start_s={start}",
        "scenario.pushes.0.duration_s=0.15",
        f"replanning.period_s={period}",
        "duration_s=6",
    )
    for period, direction, force, start in product(PERIODS, DIRECTIONS, FORCES, STARTS)
]


def report(table: pd.DataFrame) -> str:
    """Return one line a replanning period: survivals, and medians over the pushes that every period survives."""
    cases = len(TRIALS) // len(PERIODS)
    groups = [table.iloc[index * cases : (index + 1) * cases].reset_index() for index in range(len(PERIODS))]
    shared = pd.concat([group["status"] == TrialStatus.COMPLETED for group in groups], axis=1).all(axis=1)
    lines = [
        f"| replanning | upright | plans refused | one plan [ms] | roll, pitch [deg] over {int(shared.sum())} cases |",
        "|---|--:|--:|--:|--:|",
    ]
    for period, group in zip(PERIODS, groups, strict=True):
        upright = int((group["status"] == TrialStatus.COMPLETED).sum())
        name = "never" if period == "null" else f"every {period} s"
        plans, refused = group["replannings"].sum(), group["replanning_failures"].sum()
        tilt, time_ms = group.loc[shared, "roll_pitch_rms_deg"].median(), group["replanning_median_ms"].median()
        told = "- | -" if period == "null" else f"{refused:.0f} of {plans:.0f} | {time_ms:.1f}"
        lines.append(f"| {name} | {upright} of {cases} | {told} | {tilt:.2f} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(run_table("replanning_pushes", TRIALS, report, __doc__))
