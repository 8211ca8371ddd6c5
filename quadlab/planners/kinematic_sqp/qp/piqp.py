"""PIQP (BSD-2): proximal interior point with a sparse factorisation."""

import numpy as np
import piqp
from scipy.sparse import csc_matrix

from quadlab.planners.kinematic_sqp.qp.problem import QpAnswer, QuadraticProgram


class PiqpSolver:
    """Solver ``piqp``; it needs matrices with sorted indices."""

    def solve(self, program: QuadraticProgram, tolerance: float) -> QpAnswer:
        """Return the minimiser; ``tolerance`` is absolute."""
        size = len(program.gradient)
        solver = piqp.SparseSolver()
        solver.settings.eps_abs, solver.settings.eps_rel = tolerance, 0.0
        no_equalities = csc_matrix((0, size))
        solver.setup(
            csc_matrix(program.hessian),
            program.gradient,
            no_equalities,
            np.zeros(0),
            csc_matrix(program.rows),
            program.lower,
            program.upper,
        )
        solver.solve()
        result = solver.result
        return QpAnswer(np.array(result.x), np.array(result.z_u) - np.array(result.z_l))
