"""Walk and trot on both robots from ten perturbed starts, in full; table and report go to results/acceptance/.

    python experiments/acceptance.py [--jobs 2]

Trials whose result is there already are not run again. Exit code 1 if a trial did not complete.
"""

import sys
from itertools import product

import pandas as pd
from trial_table import run_table

from quadlab.trials.result import TrialStatus

SEEDS = 10
TRIALS = [
    (f"robot={robot}", f"gait={gait}", "scenario=perturbed", f"seed={seed}", "duration_s=20")
    for robot, gait, seed in product(("anymal_b", "hyq"), ("walk", "trot"), range(SEEDS))
]


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


if __name__ == "__main__":
    sys.exit(run_table("acceptance", TRIALS, report, __doc__))
