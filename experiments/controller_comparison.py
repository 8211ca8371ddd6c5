"""Every controller on every gait through one interface; goes to results/controller_comparison/.

    python experiments/controller_comparison.py [--jobs 2]

Falls are rows. Exit code 1 if a trial did not complete.
"""

import sys
from itertools import product

import pandas as pd
from trial_table import row_table, run_table

CONTROLLERS = ("hierarchical", "weighted", "gehring2017", "bellicoso2016", "projected_inverse_dynamics")
GAITS = {
    "anymal_b": ("walk", "trot", "walk_to_trot", "pace", "bound", "limp"),
    "hyq": ("walk", "trot"),
}
TRIALS = [
    (f"robot={robot}", f"gait={gait}", f"controller={controller}", "duration_s=12")
    for robot, gaits in GAITS.items()
    for gait, controller in product(gaits, CONTROLLERS)
]


def report(table: pd.DataFrame) -> str:
    """Return one line a trial."""
    return row_table(table, ("robot", "gait", "controller"))


if __name__ == "__main__":
    sys.exit(run_table("controller_comparison", TRIALS, report, __doc__))
