"""Random planning problems around the motions of Table I, to measure how reliable and how fast a transcription is."""

from dataclasses import dataclass

import numpy as np

from quadlab.geometry.rotations import rotation_2d
from quadlab.planners.problem import PlanningProblem, PlanStart, Waypoints
from quadlab.planners.vertex_zmp.table_one import HYQ, NODE_PERIODS_S, schedule_of, table_one_phases

_COSTS = ("robustness_weight", "com_acceleration_weight", "nominal_foothold_weight", "waypoint_weight")


@dataclass(frozen=True)
class RandomProblem:
    """A problem and the settings of the planner that go with it.

    Attributes:
        gait: of Table I.
        problem: not necessarily a solvable one.
        changes: settings of the vertex-ZMP planner that differ from its configuration.
    """

    gait: str
    problem: PlanningProblem
    changes: dict[str, object]


def random_problem(seed: int) -> RandomProblem:
    """Return the random problem of number ``seed``.

    Gait, number of strides, goal, turn, velocity of the CoM at the start, its place and that of the feet and the costs
    are random. About one in forty asks for too much.
    """
    random = np.random.default_rng(seed)
    gait = str(random.choice(["walk", "trot", "pace", "bound"]))
    strides = int(random.integers(1, 5))
    standing = (float(random.uniform(0.1, 0.3)), "")
    schedule = schedule_of((standing, *table_one_phases(gait) * strides, standing))
    yaw, turn = random.uniform(-np.pi, np.pi), random.uniform(-0.3, 0.3) * strides
    turned = rotation_2d(float(yaw))
    com = random.uniform(-1.0, 1.0, 2)
    feet = com + (HYQ.nominal_feet + random.uniform(-0.05, 0.05, (4, 2))) @ turned.T
    goal = com + turned @ (strides * random.uniform([-0.2, -0.1], [0.34, 0.1]))
    start = PlanStart(com, turned @ random.normal(0.0, [0.6, 0.3]), yaw, np.column_stack([feet, np.zeros(4)]))
    path = np.array([[*com, yaw], [*goal, yaw + turn]])
    problem = PlanningProblem(start, Waypoints(np.array([0.0, schedule.duration_s]), path), schedule, HYQ)
    changes: dict[str, object] = {"polynomial_duration_s": NODE_PERIODS_S[gait]}
    if random.random() < 0.5:
        changes |= dict.fromkeys(_COSTS, 0.0)
    return RandomProblem(gait, problem, changes)
