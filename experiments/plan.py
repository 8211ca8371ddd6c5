"""Plan without running: python experiments/plan.py gait=walk planner=zmp_spline duration_s=12."""

import sys

from quadlab.cli import main

if __name__ == "__main__":
    sys.exit(main(["plan", *sys.argv[1:]]))
