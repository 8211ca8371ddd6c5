"""OSQP (Apache-2): alternating directions with a sparse factorisation; quick answers, slow accuracy."""

import numpy as np
import osqp
from scipy.sparse import csc_matrix, triu

from quadlab.planners.kinematic_sqp.qp.problem import QpAnswer, QuadraticProgram

_MAX_ITERATIONS = 20000


class OsqpSolver:
    """Solver ``osqp``."""

    def solve(self, program: QuadraticProgram, tolerance: float) -> QpAnswer:
        """Return the minimiser; ``tolerance`` is absolute."""
        solver = osqp.OSQP()
        solver.setup(
            csc_matrix(triu(program.hessian, format="csc")),
            program.gradient,
            csc_matrix(program.rows),
            program.lower,
            program.upper,
            verbose=False,
            eps_abs=tolerance,
            eps_rel=0.0,
            max_iter=_MAX_ITERATIONS,
        )
        result = solver.solve(raise_error=False)
        return QpAnswer(np.array(result.x, dtype=float), np.array(result.y, dtype=float))
