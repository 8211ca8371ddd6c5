"""Bellicoso 2016, Fig. 5 and 6: an unperceived step of 14 cm, with and without limb limits; goes to results/step_down/.

    python experiments/step_down.py [--jobs 2]

Ten places of the edge within a stride. Falls are rows; exit code 1 if a trial did not complete.
"""

import sys

import pandas as pd
from trial_table import run_table

from quadlab.trials.result import TrialStatus

EDGES_M = [round(0.90 + 0.025 * place, 3) for place in range(10)]  # a stride is 0.25 m
LIMB_LEVEL = "controller.levels.4.tasks.0"
VARIANTS: dict[str, tuple[str, ...]] = {
    "with limb limits": (),
    "without": (f"{LIMB_LEVEL}.minimum=0.01", f"{LIMB_LEVEL}.maximum=9"),
}
TRIALS = [
    ("experiment=bellicoso2016_step_down", f"scenario.terrain.0.edge_x_m={edge}", *change)
    for change in VARIANTS.values()
    for edge in EDGES_M
]


def report(table: pd.DataFrame) -> str:
    """Return one line a variant and the edges at which it fell."""
    lines = ["| controller | upright | fell with the edge at [m] | CoM max of the upright [mm] |", "|---|--:|---|--:|"]
    for index, variant in enumerate(VARIANTS):
        rows = table.iloc[index * len(EDGES_M) : (index + 1) * len(EDGES_M)]
        upright = (rows["status"] == TrialStatus.COMPLETED).to_numpy()
        fell = ", ".join(f"{edge:g}" for edge, stands in zip(EDGES_M, upright, strict=True) if not stands) or "-"
        worst = f"{rows.loc[upright, 'com_error_max_mm'].max():.0f}" if upright.any() else "-"
        lines.append(f"| {variant} | {upright.sum()} of {len(rows)} | {fell} | {worst} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(run_table("step_down", TRIALS, report, __doc__))
