"""The nonlinear program of Gehring 2017, Eq. (1), as a list of named terms."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array, vstack

from quadlab.geometry.rotations import Array
from quadlab.planners.kinematic_sqp.elimination import Elimination
from quadlab.planners.kinematic_sqp.grid import SampleGrid
from quadlab.planners.kinematic_sqp.hessian import HessianAssembly, hessian_assembly
from quadlab.planners.kinematic_sqp.kinematics import SampleKinematics
from quadlab.planners.kinematic_sqp.layout import SampleLayout
from quadlab.planners.kinematic_sqp.term import BlockTerm, Coordinates, Equality, Inequality, Jacobians, LinearTerm

_CONSISTENCY = ("com_consistency", "feet_consistency")


@dataclass(frozen=True)
class Linearisation:
    """Gauss-Newton model of the objective about one iterate.

    Attributes:
        hessian: (size of y, size of y).
        gradient: (size of y,).
    """

    hessian: csc_array
    gradient: Array


@dataclass(frozen=True)
class KinematicProgram:
    """min sum_j alpha_j f_j(p) with linear equalities, which are eliminated, and linear inequalities.

    Attributes:
        layout: of p.
        grid: samples in time.
        kinematics: of the robot.
        linear_terms, block_terms: the objectives.
        equalities, inequalities: the constraints.
        elimination: p = T y + p_0.
        guess: first iterate p, (size of p,).
        damping: added to the diagonal of the Hessian.
    """

    layout: SampleLayout
    grid: SampleGrid
    kinematics: SampleKinematics
    linear_terms: Sequence[LinearTerm]
    block_terms: Sequence[BlockTerm]
    equalities: Sequence[Equality]
    inequalities: Sequence[Inequality]
    elimination: Elimination
    guess: Array
    damping: float

    @cached_property
    def _linear_rows(self) -> tuple[csr_array, Array]:
        """All linear terms, times the root of their weights, as one residual of y."""
        roots = [np.sqrt(term.weight) for term in self.linear_terms]
        scaled = [root * term.matrix for root, term in zip(roots, self.linear_terms, strict=True)]
        matrix = csr_array(vstack(scaled, format="csr"))
        target = np.concatenate([root * term.target for root, term in zip(roots, self.linear_terms, strict=True)])
        return csr_array(matrix @ self.elimination.matrix), target - matrix @ self.elimination.constant

    @cached_property
    def _assembly(self) -> HessianAssembly:
        rows, _ = self._linear_rows
        constant = 2.0 * (rows.T @ rows) + self.damping * eye_array(rows.shape[1])
        variables = [term.variables for term in self.block_terms]
        return hessian_assembly(self.elimination.matrix, variables, csc_array(constant))

    @cached_property
    def _transposed(self) -> csr_array:
        return csr_array(self.elimination.matrix.T)

    def prepare(self) -> None:
        """Do now what the first linearisation would do once."""
        _ = self._assembly, self._transposed

    def coordinates(self, p: Array) -> Coordinates:
        """Return CoM and feet of the configurations in p."""
        return Coordinates(*self.kinematics.positions(self.layout.poses(p)))

    def costs(self, p: Array) -> dict[str, float]:
        """Return alpha_j f_j(p) by name."""
        coordinates = self.coordinates(p)
        values = {term.name: term.weight * _squares(term.residual(p, coordinates)) for term in self.block_terms}
        return values | {term.name: term.weight * _squares(term.residual(p)) for term in self.linear_terms}

    def violations(self, p: Array) -> dict[str, float]:
        """Return the largest violation of each constraint set, by names that carry the unit."""
        values = {equality.name: equality.violation(p) for equality in self.equalities}
        return values | {inequality.name: inequality.violation(p) for inequality in self.inequalities}

    def consistency(self, p: Array) -> dict[str, float]:
        """Return the largest distance of auxiliary and true points, Eq. (3), of CoM and feet in [mm]."""
        coordinates = self.coordinates(p)
        return {
            f"{term.name}_mm": 1e3 * float(np.linalg.norm(term.residual(p, coordinates), axis=1).max())
            for term in self.block_terms
            if term.name in _CONSISTENCY
        }

    def linearise(self, y: Array) -> Linearisation:
        """Return the Gauss-Newton model 2 J^T J, 2 J^T r of the objective at y."""
        p = self.elimination.expand(y)
        coordinates = self.coordinates(p)
        jacobians = Jacobians(*self.kinematics.jacobians(self.layout.poses(p)))
        gradient, blocks = np.zeros(self.layout.size), []
        for term in self.block_terms:
            jacobian = term.jacobian(p, jacobians)
            weighted = 2.0 * term.weight * jacobian.transpose(0, 2, 1)
            slopes = (weighted @ term.residual(p, coordinates)[:, :, None])[:, :, 0]
            gradient += np.bincount(term.variables.ravel(), weights=slopes.ravel(), minlength=self.layout.size)
            blocks.append(weighted @ jacobian)
        rows, target = self._linear_rows
        linear = 2.0 * (rows.T @ (rows @ y - target))
        return Linearisation(self._assembly.assemble(blocks), self._transposed @ gradient + linear)


def _squares(residual: Array) -> float:
    return float(np.vdot(residual, residual))
