"""Small contact forces, which also fixes the internal forces that motion leaves free (Bellicoso 2016, Eq. 21)."""

from typing import Literal

import numpy as np

from quadlab.configuration import StrictModel, register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.task import TaskRows, Variable, equation
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.legs import LEG_COUNT

_ROWS = [equation(Variable.FORCE, np.eye(3 * legs), np.zeros(3 * legs)) for legs in range(LEG_COUNT + 1)]
"""By number of standing legs."""


@register("task", "contact_force_minimisation")
class ContactForceMinimisationTask:
    """lambda = 0 as far as higher priorities leave it free."""

    class Config(StrictModel):
        """It has no parameters."""

        task: Literal["contact_force_minimisation"]

    def __init__(self, config: Config) -> None:
        self.config = config

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return three rows in forces for each standing leg."""
        return _ROWS[len(reference.stance_legs)]
