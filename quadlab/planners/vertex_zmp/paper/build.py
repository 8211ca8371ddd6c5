"""The paper's formulation, with additions, and the solver that was made for it."""

import time
from dataclasses import dataclass

from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan, PlanReport
from quadlab.planners.problem import PlanningProblem
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.paper.motion import motion_plan
from quadlab.planners.vertex_zmp.paper.solver import IpoptSolver, make_solver, run_solver
from quadlab.planners.vertex_zmp.paper.transcription import Transcription, transcribe
from quadlab.planners.vertex_zmp.solution import Solution


@dataclass(frozen=True)
class PaperBuild:
    """A transcription and its solver.

    Attributes:
        transcription: the nonlinear program.
        solver: Ipopt, ready to run.
        build_ms: wall time of both in [ms].
    """

    transcription: Transcription
    solver: IpoptSolver
    build_ms: float

    @property
    def problem(self) -> PlanningProblem:
        """The problem in words."""
        return self.transcription.problem

    @property
    def size(self) -> tuple[int, int]:
        """Number of variables and of constraints."""
        constraints = sum(len(constraint.lower) for constraint in self.transcription.constraints)
        return self.transcription.layout.size, constraints

    def solve(self) -> Solution:
        """Run Ipopt from the first iterate of the transcription."""
        return run_solver(self.solver, self.transcription)

    def motion_plan(self, x: Array, report: PlanReport) -> MotionPlan:
        """Return the plan of the iterate ``x``; its verdict is empty until it has been checked."""
        return motion_plan(self.transcription, x, report)


def build_paper(problem: PlanningProblem, config: VertexZmpConfig) -> PaperBuild:
    """Return the program of a well-formed problem in the paper's formulation and Ipopt for it."""
    begin = time.perf_counter()
    transcription = transcribe(problem, config)
    solver = make_solver(transcription, config)
    return PaperBuild(transcription, solver, 1e3 * (time.perf_counter() - begin))
