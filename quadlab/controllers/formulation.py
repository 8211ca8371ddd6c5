"""The choice of decision variables: reduced to the torques, or the decision vectors of the papers."""

from collections.abc import Callable
from typing import Literal, TypeAlias

from quadlab.controllers.decision_space import DecisionSpace
from quadlab.controllers.full_space import accelerations_forces, accelerations_torques
from quadlab.controllers.reduced_dynamics import reduce_dynamics
from quadlab.robots.kinematics import Kinematics

FormulationName: TypeAlias = Literal["reduced", "accelerations_torques", "accelerations_forces"]

FORMULATIONS: dict[FormulationName, Callable[[Kinematics, list[int]], DecisionSpace]] = {
    "reduced": reduce_dynamics,
    "accelerations_torques": accelerations_torques,
    "accelerations_forces": accelerations_forces,
}
"""Functions from kinematics and numbers of the standing legs to the decision space of a tick."""


def constraint_names(formulation: FormulationName) -> tuple[str, ...]:
    """Return the names of the levels that stand above all tasks."""
    return () if formulation == "reduced" else ("dynamics", "contacts")
