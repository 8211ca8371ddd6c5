"""Walk and trot in closed loop on the plans of every planner that supports the gait; goes to results/plan_tracking/.

    python experiments/plan_tracking.py [--jobs 2]

``zmp_spline`` plans walks only: the support of a trot is a segment. Exit code 1 if a trial did not complete.
"""

import sys
from itertools import product

import pandas as pd
from trial_table import row_table, run_table

PLANNERS = (
    ("planner=vertex_zmp",),
    ("planner=vertex_zmp_paper",),
    ("planner=kinematic_sqp",),
    ("planner=zmp_spline",),
)
TRIALS = [
    (f"robot={robot}", f"gait={gait}", *planner, "duration_s=12")
    for robot, gait, planner in product(("anymal_b", "hyq"), ("walk", "trot"), PLANNERS)
    if not (gait == "trot" and planner == ("planner=zmp_spline",))
]


def report(table: pd.DataFrame) -> str:
    """Return one line a trial."""
    return row_table(table, ("robot", "gait", "planner"))


if __name__ == "__main__":
    sys.exit(run_table("plan_tracking", TRIALS, report, __doc__))
