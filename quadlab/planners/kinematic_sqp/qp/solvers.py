"""The solvers by name."""

from quadlab.planners.kinematic_sqp.qp.osqp import OsqpSolver
from quadlab.planners.kinematic_sqp.qp.piqp import PiqpSolver
from quadlab.planners.kinematic_sqp.qp.problem import QpSolver
from quadlab.planners.kinematic_sqp.qp.proxqp import ProxQpSolver

QP_SOLVERS: dict[str, type[QpSolver]] = {"proxqp": ProxQpSolver, "piqp": PiqpSolver, "osqp": OsqpSolver}
"""All solvers, by the name under which a configuration asks for them."""
