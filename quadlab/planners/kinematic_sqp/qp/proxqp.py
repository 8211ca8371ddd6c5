"""ProxQP (proxsuite, BSD-2): proximal augmented Lagrangian with a sparse factorisation."""

import numpy as np
import proxsuite
from scipy.sparse import csc_matrix

from quadlab.planners.kinematic_sqp.qp.problem import QpAnswer, QuadraticProgram

_MAX_ITERATIONS = 100  # outer and inner ones each; ten are usual
_NEVER_INFEASIBLE = 1e-14  # its tests of infeasibility give up on feasible problems; the residuals decide


class ProxQpSolver:
    """Solver ``proxqp``."""

    def solve(self, program: QuadraticProgram, tolerance: float) -> QpAnswer:
        """Return the minimiser; ``tolerance`` is absolute."""
        count, size = program.rows.shape
        solver = proxsuite.proxqp.sparse.QP(size, 0, count)
        solver.settings.eps_abs = tolerance
        solver.settings.max_iter = solver.settings.max_iter_in = _MAX_ITERATIONS
        solver.settings.eps_primal_inf = solver.settings.eps_dual_inf = _NEVER_INFEASIBLE
        hessian, rows = csc_matrix(program.hessian), csc_matrix(program.rows)
        solver.init(hessian, program.gradient, None, None, rows, program.lower, program.upper)
        solver.solve()
        return QpAnswer(np.array(solver.results.x), np.array(solver.results.z))
