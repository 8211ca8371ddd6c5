"""Time of planning and of a control tick on this machine, measured side by side; simulated time plays no part.

    python experiments/bench.py [--repeats 7]

Medians over the repetitions of planning and over the ticks of closed-loop trials. The machine's load is in the
numbers: compare rows of one run, not runs.
"""

import argparse
import statistics
import sys
import time
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from threadpoolctl import threadpool_limits

from quadlab.analysis.log_reader import read_log
from quadlab.robots.model import load_robot
from quadlab.simulation.simulator import Simulator
from quadlab.trials.compose import compose_trial
from quadlab.trials.planning import build_planner, planning_problem
from quadlab.trials.progress import SilentProgress
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.runner import run_trial

ROBOTS = ("anymal_b", "hyq")
GAITS = ("walk", "trot")
DURATION_S = 12.0
PARTS = ("model_us", "reference_us", "solve_us")


def bench_planner(robot_name: str, gait: str, repeats: int) -> str:
    """Return one line: median build and solve time of a plan of 12 s."""
    config = compose_trial([f"robot={robot_name}", f"gait={gait}", f"duration_s={DURATION_S:g}"])
    robot = load_robot(config.robot)
    state = Simulator(robot, config.scenario, config.simulation, config.seed).read()
    problem = planning_problem(config, robot, state)
    planner: Any = build_planner(config)
    planner.prepare()
    builds, solves = [], []
    for _ in range(repeats):
        began = time.perf_counter()
        built = planner.build(problem)
        builds.append(time.perf_counter() - began)
        outcome = planner.solve(built)
        if outcome.plan is None:
            return f"{robot_name:9} {gait:5} no plan: {outcome.status}: {outcome.reason}"
        solves.append(outcome.plan.report.solve_ms)
    report = outcome.plan.report
    return (
        f"{robot_name:9} {gait:5} build {1e3 * statistics.median(builds):7.1f} ms  "
        f"solve {statistics.median(solves):7.1f} ms  {report.iterations:3d} iterations  "
        f"{report.variables} variables  {report.constraints} constraints"
    )


def bench_controller(robot_name: str, gait: str) -> list[str]:
    """Return lines: median and 99th percentile of a control tick by the number of standing legs."""
    config = compose_trial([f"robot={robot_name}", f"gait={gait}", f"duration_s={DURATION_S:g}"])
    with TemporaryDirectory() as folder:
        result = run_trial(config, Path(folder), SilentProgress())
        log = read_log(Path(folder) / LOG_FILE)
    modes = log.control.filter(regex=r"^leg_mode_")
    standing = (modes == 0).sum(axis=1)
    timing = log.timing
    lines = []
    for legs in sorted(standing.unique(), reverse=True):
        rows = timing[(standing == legs).to_numpy()]
        total = rows["tick_us"]
        parts = "  ".join(f"{name.removesuffix('_us')} {rows[name].median():4.0f}" for name in PARTS)
        lines.append(
            f"{robot_name:9} {gait:5} {legs} legs standing: tick median {total.median():5.0f} us  "
            f"p99 {total.quantile(0.99):5.0f} us  ({parts} us; {len(rows)} ticks)"
        )
    factor = result.real_time_factor or 0.0
    return [*lines, f"{robot_name:9} {gait:5} whole loop with log: {factor:.2f} x real time"]


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7, help="repetitions of planning")
    repeats = parser.parse_args().repeats
    with threadpool_limits(1):
        sys.stdout.write(f"planner vertex_zmp, {DURATION_S:g} s, median of {repeats}\n")
        for robot, gait in product(ROBOTS, GAITS):
            sys.stdout.write(f"  {bench_planner(robot, gait, repeats)}\n")
            sys.stdout.flush()
        sys.stdout.write("controller hierarchical, closed loop\n")
        for robot, gait in product(ROBOTS, GAITS):
            for line in bench_controller(robot, gait):
                sys.stdout.write(f"  {line}\n")
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
