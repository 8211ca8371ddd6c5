"""Plan without running: python experiments/plan.py gait=walk planner=zmp_spline duration_s=12."""

import sys

from quadlab.plotting.plan_files import main

if __name__ == "__main__":
    sys.exit(main())
