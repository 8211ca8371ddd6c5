"""Machine code before the clock runs: compiled once a machine, loaded once a process."""

from functools import cache

import numpy as np

from quadlab.gaits.schedule import ContactSchedule
from quadlab.planners.problem import PlanningModel, PlanningProblem, PlanStart, Waypoints
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.fast.build import build_fast

_FEET = np.array([[0.3, 0.2], [0.3, -0.2], [-0.3, 0.2], [-0.3, -0.2]])  # [m]
_DURATION_S = 0.2


@cache
def load_compiled(config: VertexZmpConfig) -> None:
    """Solve the smallest problem there is, standing, so that later times are those of their problems."""
    feet = np.column_stack([_FEET, np.zeros(len(_FEET))])
    problem = PlanningProblem(
        start=PlanStart(com_position=np.zeros(2), com_velocity=np.zeros(2), yaw=0.0, feet=feet),
        waypoints=Waypoints(np.array([0.0, _DURATION_S]), np.zeros((2, 3))),
        schedule=ContactSchedule(np.array([_DURATION_S]), np.ones((1, len(_FEET)), dtype=bool)),
        model=PlanningModel(com_height=0.5, nominal_feet=_FEET, reach=np.array([0.1, 0.1])),
    )
    build_fast(problem, config).solve()
