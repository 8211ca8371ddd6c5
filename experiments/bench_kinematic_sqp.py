"""Time, convergence and costs of the kinematic planner on the three motions of Gehring 2017, Table I.

    python experiments/bench_kinematic_sqp.py [--robot anymal_b] [--repeats 7] [--random 100]

Two cycles from standing without stances around them, as in the paper: the second one is periodic. Medians of wall
time: building the program, the first solution after it and repeated ones, for every QP solver. Then the cost of every
objective beside the paper's, and the share of random starts and commands that converge. The paper prints neither the
distances of trot and transition nor clearance, w_min and regulariser, so costs can only be compared in magnitude.
"""

import argparse
import statistics
import sys
import time
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from threadpoolctl import threadpool_limits

from quadlab.gaits.gait import CycleConfig, GaitConfig, contact_schedule, stride_times
from quadlab.geometry.rotations import matrix_to_quat, rotation_zyx
from quadlab.planners.command import PerStrideCommand, waypoints
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.planners.kinematic_sqp.planner import KinematicSqpPlanner
from quadlab.planners.kinematic_sqp.qp.solvers import QP_SOLVERS
from quadlab.planners.kinematic_sqp.sqp import Minimum, minimise, objective_history
from quadlab.planners.problem import PlanningProblem
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState
from quadlab.trials.compose import compose_trial
from quadlab.trials.planning import plan_start, planning_model

PAPER_COSTS = {
    "com_consistency": (0.41, 0.01, 0.12),
    "feet_consistency": (0.23, 0.01, 0.09),
    "dynamic_stability": (2.18, 0.02, 1.00),
    "travel_distance_transition": (11.95, 2.91, 15.79),
    "travel_distance_periodic": (5.71, 0.25, 1.64),
    "turning_angle_periodic": (0.05, 0.00, 0.00),
    "smooth_base": (5.57, 0.04, 1.12),
    "smooth_joints": (3.08, 1.26, 1.46),
    "smooth_com": (0.40, 0.001, 0.10),
    "smooth_feet": (2.27, 0.08, 0.34),
}
"""Table I: walk, trot, transition."""


@dataclass(frozen=True)
class Motion:
    """Two gaits with their stride durations in [s], and what is commanded a stride in [m] and [deg]."""

    gaits: tuple[str, str]
    strides_s: tuple[float, float]
    command: PerStrideCommand


def _command(x_m: float, y_m: float, yaw_deg: float) -> PerStrideCommand:
    return PerStrideCommand(kind="per_stride", x_m=x_m, y_m=y_m, yaw_deg=yaw_deg)


TABLE_I = {
    "walk": Motion(("walk", "walk"), (5.0, 5.0), _command(0.2, 0.0, 0.0)),
    "trot": Motion(("trot", "trot"), (0.8, 0.8), _command(0.15, 0.0, 0.0)),
    "transition": Motion(("walk", "trot"), (4.0, 0.8), _command(0.2, 0.0, 0.0)),
}
OTHERS = {
    "turning trot": Motion(("trot", "trot"), (0.8, 0.8), _command(0.0, 0.0, 20.0)),
    "sideways walk": Motion(("walk", "walk"), (5.0, 5.0), _command(0.0, 0.1, 0.0)),
}
"""The three motions of Table I and two others."""


def paper_problem(robot: RobotModel, state: RobotState, motion: Motion) -> PlanningProblem:
    """Return the problem of two cycles that begin in ``state``."""
    cycles = tuple(
        _pattern(name).model_copy(update={"stride_duration_s": duration, "strides": 1})
        for name, duration in zip(motion.gaits, motion.strides_s, strict=True)
    )
    gait = GaitConfig(name="+".join(motion.gaits), initial_stance_s=0.0, final_stance_s=0.0, cycles=cycles)
    start, duration_s = plan_start(robot, state), sum(motion.strides_s)
    pose = np.array([*start.com_position, start.yaw])
    return PlanningProblem(
        start=start,
        waypoints=waypoints(motion.command, stride_times(gait, duration_s), pose, duration_s),
        schedule=contact_schedule(gait, duration_s),
        model=planning_model(robot),
        robot=robot,
    )


@cache
def _pattern(name: str) -> CycleConfig:
    return compose_trial([f"gait={name}", "duration_s=20"]).gait.cycles[0]


def settings(qp_solver: str | None = None) -> KinematicSqpConfig:
    """Return the planner's settings, with another QP solver if one is named."""
    overrides = ["planner=kinematic_sqp", *([f"planner.sqp.qp_solver={qp_solver}"] if qp_solver else [])]
    planner = compose_trial(overrides).planner
    if not isinstance(planner, KinematicSqpConfig):
        raise TypeError(f"conf/planner/kinematic_sqp.yaml: a {type(planner).__name__}")
    return planner


def bench(problem: PlanningProblem, config: KinematicSqpConfig, repeats: int) -> tuple[str, Minimum]:
    """Return one line of medians, and the minimum."""
    planner = KinematicSqpPlanner(config)
    builds, firsts, again, minimum = [], [], [], None
    for _ in range(repeats):
        built = planner.build(problem)
        builds.append(built.build_ms)
        firsts.append(minimise(built.program, config.sqp).solve_ms)
        minimum = minimise(built.program, config.sqp)
        again.append(minimum.solve_ms)
    if minimum is None:
        raise ValueError("repeats: expected at least 1")
    line = (
        f"build {statistics.median(builds):6.1f} ms  first {statistics.median(firsts):7.1f} ms  "
        f"repeated {statistics.median(again):7.1f} ms  {len(minimum.steps):2d} iterations  "
        f"objective {objective_history(minimum)[-1]:9.4f}  {minimum.reason}"
    )
    return line, minimum


def table_of_costs(minima: dict[str, Minimum]) -> list[str]:
    """Return lines: the cost of every objective, ours and the paper's."""
    lines = [f"{'objective':28}" + "".join(f"{name:>12}{'paper':>8}" for name in minima)]
    for objective in next(iter(minima.values())).history[-1]:
        paper = PAPER_COSTS.get(objective, ("", "", ""))
        cells = [
            f"{m.history[-1][objective]:12.4f}{value!s:>8}" for m, value in zip(minima.values(), paper, strict=True)
        ]
        lines.append(f"{objective:28}" + "".join(cells))
    return lines


def random_start(robot: RobotModel, random: np.random.Generator) -> RobotState:
    """Return a stance with another pose, other joints and a small velocity."""
    state = robot.nominal_state()
    roll, pitch, yaw = random.uniform(-1.0, 1.0, 3) * np.array([0.05, 0.05, 0.5])
    return replace(
        state,
        position_base_in_world=state.position_base_in_world + random.uniform(-0.02, 0.02, 3),
        quat_wxyz=matrix_to_quat(rotation_zyx(yaw, pitch, roll)),
        joint_positions=state.joint_positions + random.uniform(-0.05, 0.05, 12),
        linear_velocity_base_in_world=random.uniform(-0.05, 0.05, 3),
    )


def bench_random(robot: RobotModel, config: KinematicSqpConfig, count: int) -> list[str]:
    """Return lines: how many random starts and commands converge, iterations and times; every failure by its seed."""
    gaits, lines = list(TABLE_I.values()), []
    iterations, times = [], []
    for seed in range(count):
        random = np.random.default_rng(seed)
        x_m, y_m, yaw_deg = (float(value) for value in random.uniform(-1.0, 1.0, 3) * np.array([0.2, 0.1, 20.0]))
        motion = replace(gaits[seed % len(gaits)], command=_command(x_m, y_m, yaw_deg))
        built = KinematicSqpPlanner(config).build(paper_problem(robot, random_start(robot, random), motion))
        minimum = minimise(built.program, config.sqp)
        if minimum.converged:
            iterations.append(len(minimum.steps))
            times.append(minimum.solve_ms)
        else:
            lines.append(f"seed {seed} {'+'.join(motion.gaits)}: {minimum.reason}")
    lines.append(
        f"{len(times)} of {count} converged; iterations median {statistics.median(iterations):g}, "
        f"largest {max(iterations)}; median {statistics.median(times):.1f} ms, largest {max(times):.1f} ms"
    )
    return lines


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="anymal_b")
    parser.add_argument("--repeats", type=int, default=7, help="repetitions of building and solving")
    parser.add_argument("--random", type=int, default=100, help="random starts and commands; 0 leaves them out")
    arguments = parser.parse_args()
    robot, minima = load_robot(robot_config(arguments.robot)), {}
    began = time.perf_counter()
    with threadpool_limits(1):
        for name, motion in {**TABLE_I, **OTHERS}.items():
            problem = paper_problem(robot, robot.nominal_state(), motion)
            for solver in QP_SOLVERS:
                line, minimum = bench(problem, settings(solver), arguments.repeats)
                _print(f"{name:14} {solver:10} {line}")
            if name in TABLE_I:
                minima[name] = minimum
        for line in table_of_costs(minima):
            _print(line)
        if arguments.random:
            for line in bench_random(robot, settings(), arguments.random):
                _print(line)
    _print(f"{time.perf_counter() - began:.0f} s in all")
    return 0


def _print(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
