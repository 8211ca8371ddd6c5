"""Run one trial, or a sweep with -m: python experiments/run_trial.py robot=anymal_b gait=trot."""

import sys

from quadlab.cli import main

if __name__ == "__main__":
    sys.exit(main(["run", *sys.argv[1:]]))
