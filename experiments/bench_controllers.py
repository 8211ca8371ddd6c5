"""Time of a control tick by controller and number of standing feet: model, reference, assembly, solve.

    python experiments/bench_controllers.py [--robot anymal_b] [--repeats 3] [--closed-loop] [--controllers NAME ...]

A trial is simulated once; its measured states are then given to a fresh controller again and again, which must return
the same torques bit by bit. The time of a tick is the smallest over the repetitions, so that a busy machine does not
count; with ``--closed-loop`` it is that of the simulated trial, where the physics have emptied the caches in between.
Assembly writes dynamics, tasks and limits as rows of the solver; controllers without it count everything as solve.

The first line is a yardstick: Pinocchio's ``computeAllTerms``, a piece of compiled code that every tick contains.
Machines are compared by ticks in units of it.
"""

import argparse
import gc
import sys
import time
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import pinocchio as pin
from threadpoolctl import threadpool_limits

from quadlab.controllers.reference import ControlReference
from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.controllers.tracking_controller import TrackingController, build_controller
from quadlab.errors import QuadlabError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.robots.catalogue import robot_config
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import RobotState
from quadlab.simulation.simulator import Simulator
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import TrialConfig
from quadlab.trials.planning import build_planner, planning_problem

CONTROLLERS = ("hierarchical", "bellicoso2016", "gehring2017", "weighted", "projected_inverse_dynamics")
GAITS = ("walk", "trot")
DURATION_S = 8.0
PARTS = ("model", "reference", "assembly", "solve", "all but ref.", "tick")


@dataclass(frozen=True)
class Ticks:
    """Computing time and outcome of the ticks of one pass.

    Attributes:
        timings_us: model, reference, assembly and solve, (ticks, 4) in [us].
        standing: number of standing feet, (ticks,).
        torques: (ticks, 12) in [N m].
        fallbacks: ticks in which the solver's answer was not used.
    """

    timings_us: Array
    standing: Array
    torques: Array
    fallbacks: int


class AssemblyClock:
    """Measures the assembly of a controller's levels, which is a part of its solve time."""

    def __init__(self, controller: TrackingController) -> None:
        self.times_us: list[float] = []
        self._assemble: Any = getattr(controller.resolver, "assemble", None)
        if self._assemble is not None:
            controller.resolver.assemble = self._timed  # type: ignore[attr-defined]

    def _timed(self, kinematics: Kinematics, reference: ControlReference) -> Any:
        began = time.perf_counter()
        assembled = self._assemble(kinematics, reference)
        self.times_us.append(1e6 * (time.perf_counter() - began))
        return assembled


def collect(telemetry: list[ControlTelemetry], clock: AssemblyClock) -> Ticks:
    """Return the numbers of a pass."""
    assembly = np.array(clock.times_us or np.zeros(len(telemetry)))
    whole = np.array([[tick.model_us, tick.reference_us, tick.solve_us] for tick in telemetry])
    return Ticks(
        timings_us=np.column_stack([whole[:, :2], assembly, whole[:, 2] - assembly]),
        standing=np.array([tick.leg_modes.count(LegMode.STANCE) for tick in telemetry]),
        torques=np.array([tick.torques_desired for tick in telemetry]),
        fallbacks=telemetry[-1].fallbacks,
    )


def simulate(config: TrialConfig, robot: RobotModel) -> tuple[MotionPlan, list[RobotState], Ticks]:
    """Return plan, measured states and ticks of a closed loop."""
    simulator = Simulator(robot, config.scenario, config.simulation, config.seed)
    planner = build_planner(config)
    outcome = planner.solve(planner.build(planning_problem(config, robot, simulator.read())))
    if outcome.plan is None:
        raise QuadlabError(f"bench: no plan: {outcome.status}: {outcome.reason}")
    controller = build_controller(config.controller, robot)
    clock = AssemblyClock(controller)
    states = [simulator.read()]
    controller.start(outcome.plan, states[0])
    telemetry = []
    for _ in range(round(config.duration_s / controller.period_s)):
        command, report = controller.tick(states[-1])
        telemetry.append(report)
        simulator.advance(command, controller.period_s)
        states.append(simulator.read())
    return outcome.plan, states[:-1], collect(telemetry, clock)


def replay(config: TrialConfig, robot: RobotModel, plan: MotionPlan, states: list[RobotState]) -> Ticks:
    """Return the ticks of a fresh controller that is given ``states``."""
    controller = build_controller(config.controller, robot)
    clock = AssemblyClock(controller)
    controller.start(plan, states[0])
    gc.collect()
    gc.disable()
    telemetry = [controller.tick(state)[1] for state in states]
    gc.enable()
    return collect(telemetry, clock)


def bench(controller: str, robot_name: str, gait: str, repeats: int) -> list[str]:
    """Return one line for each number of standing feet; ``repeats`` = 0 takes the times of the closed loop."""
    overrides = [f"controller={controller}", f"robot={robot_name}", f"gait={gait}", f"duration_s={DURATION_S:g}"]
    config = compose_trial(overrides)
    robot = load_robot(config.robot)
    plan, states, loop = simulate(config, robot)
    passes = [replay(config, robot, plan, states) for _ in range(repeats)] or [loop]
    identical = all(each.torques.tobytes() == loop.torques.tobytes() for each in passes)
    best = np.min([each.timings_us for each in passes], axis=0)
    columns = np.column_stack([best, best.sum(axis=1) - best[:, 1], best.sum(axis=1)])
    notes = ("" if identical else "  TORQUES DIFFER") + (f"  {loop.fallbacks} fallbacks" if loop.fallbacks else "")
    lines = []
    for feet in sorted(set(loop.standing.tolist()), reverse=True):
        rows = columns[loop.standing == feet]
        cells = "".join(f"{np.median(column):8.0f} {np.percentile(column, 99):6.0f}" for column in rows.T)
        lines.append(f"{controller:27}{gait:6}{feet:4}{len(rows):7}{cells}{notes}")
    return lines


def yardstick_us(robot_name: str) -> float:
    """Return the median time of Pinocchio's ``computeAllTerms`` in the nominal stance, in [us]."""
    model = load_robot(robot_config(robot_name)).pin_model
    data, q, v = model.createData(), pin.neutral(model), np.zeros(model.nv)
    times = []
    for _ in range(2000):
        began = time.perf_counter()
        pin.computeAllTerms(model, data, q, v)
        times.append(time.perf_counter() - began)
    return 1e6 * float(np.median(times))


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="anymal_b", help="name in conf/robot")
    parser.add_argument("--repeats", type=int, default=3, help="passes over the same states")
    parser.add_argument("--closed-loop", action="store_true", help="times within the simulated trial instead")
    parser.add_argument("--controllers", nargs="+", default=CONTROLLERS, help="names in conf/controller")
    arguments = parser.parse_args()
    repeats = 0 if arguments.closed_loop else arguments.repeats
    sys.stdout.write(f"computeAllTerms: {yardstick_us(arguments.robot):.1f} us\n")
    sys.stdout.write(f"{'median and p99 in us':27}{'gait':6}{'feet':>4}{'ticks':>7}")
    sys.stdout.write("".join(f"{part:>15}" for part in PARTS) + "\n")
    with threadpool_limits(1):
        for controller, gait in product(arguments.controllers, GAITS):
            for line in bench(controller, arguments.robot, gait, repeats):
                sys.stdout.write(f"{line}\n")
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
