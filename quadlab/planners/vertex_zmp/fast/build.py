"""The reduced transcription, planned and ready to be solved."""

import time
from dataclasses import dataclass

import numpy as np

from quadlab.errors import PlanningProblemError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan, PlanReport
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.fast.motion import motion_plan
from quadlab.planners.vertex_zmp.fast.solve import PreparedProgram, prepare, solve
from quadlab.planners.vertex_zmp.fast.transcription import ReducedTranscription, transcribe
from quadlab.planners.vertex_zmp.solution import Solution

_LARGEST_ANGLE = 10.0  # w T beyond which hyperbolic functions lose the digits that matter


@dataclass(frozen=True)
class FastBuild:
    """A reduced transcription with the plan of its factorisation.

    Attributes:
        transcription: the bilinear program and what its letters mean.
        prepared: the program for the compiled solver.
        config: settings.
        build_ms: wall time of all of it in [ms].
    """

    transcription: ReducedTranscription
    prepared: PreparedProgram
    config: VertexZmpConfig
    build_ms: float

    @property
    def problem(self) -> PlanningProblem:
        """The problem in words."""
        return self.transcription.model.problem

    @property
    def size(self) -> tuple[int, int]:
        """Number of variables and of constraints."""
        program = self.transcription.program
        return program.size, len(program.right) + len(program.lower)

    def solve(self) -> Solution:
        """Run the interior-point method from the first iterate of the transcription."""
        return solve(self.prepared, self.transcription.guess, self.config)

    def motion_plan(self, x: Array, report: PlanReport) -> MotionPlan:
        """Return the plan of the iterate ``x``; its verdict is empty until it has been checked."""
        return motion_plan(self.transcription.model, self.transcription.vector(x), report)


def build_fast(problem: PlanningProblem, config: VertexZmpConfig) -> FastBuild:
    """Return the reduced program of a well-formed problem and the plan of its factorisation.

    Raises:
        PlanningProblemError: if the feet are not points (the yaw of a longer foot is not bilinear), or if the pendulum
            falls too fast for the time between load nodes.
    """
    vertices = problem.model.foot_vertices
    if len(vertices) != 1 or vertices.any():
        raise PlanningProblemError(
            f"planner.transcription: 'fast' knows point feet, the model has feet with {len(vertices)} vertices; "
            "choose 'paper'"
        )
    model, longest_s = problem.model, config.polynomial_duration_s
    angle = longest_s * np.sqrt(model.gravity / model.com_height)
    if angle > _LARGEST_ANGLE:
        raise PlanningProblemError(
            f"model.com_height: at {model.com_height:g} m the pendulum falls e^{angle:.0f}-fold in "
            f"polynomial_duration_s {longest_s:g} s, expected at most e^{_LARGEST_ANGLE:.0f}; choose shorter ones"
        )
    begin = time.perf_counter()
    transcription = transcribe(problem, config)
    prepared = prepare(transcription.program)
    return FastBuild(transcription, prepared, config, 1e3 * (time.perf_counter() - begin))
