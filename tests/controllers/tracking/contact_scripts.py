"""Scripts of the forces under the feet, for tests of the contact machine."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from controller_cases import tracking_config

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.balance import Balance
from quadlab.controllers.tracking.contact_machine import ContactMachine, start_contacts
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.rotations import Array

STANCE, SWING, SEARCH = LegMode.STANCE, LegMode.SWING, LegMode.SEARCH
PERIOD, WEIGHT = 0.0025, 400.0  # [s], [N]
FEET = np.array([[0.3, 0.2, 0.0], [0.3, -0.2, 0.0], [-0.3, 0.2, 0.0], [-0.3, -0.2, 0.0]])
LF, RF, LH, RH = range(4)
Loads = Callable[[float], Sequence[bool]]


def one_leg_schedule() -> ContactSchedule:
    """LF is in the air over [0.2, 0.5], [0.8, 1.1] and [1.4, 1.7]; the others stand."""
    contacts = np.ones((7, 4), dtype=bool)
    contacts[1::2, LF] = False
    return ContactSchedule(np.full(7, 0.3) - np.array([0.1, *np.zeros(6)]), contacts)


def diagonal_schedule() -> ContactSchedule:
    """LF and RH are in the air over [0.2, 0.5]."""
    contacts = np.ones((3, 4), dtype=bool)
    contacts[1, [LF, RH]] = False
    return ContactSchedule(np.array([0.2, 0.3, 0.3]), contacts)


def machine_for(schedule: ContactSchedule, **changes: Any) -> ContactMachine:
    return start_contacts(tracking_config(contact=changes).contact, schedule, WEIGHT, FEET)


AS_PLANNED = Balance(FEET[:, :2], np.zeros(2), np.zeros(2))


@dataclass
class Script:
    """Runs a machine and remembers when its modes changed.

    Attributes:
        machine: under test.
        balance: told to the machine in every tick.
        time_s: plan time of the last tick.
        changes: (time, leg, new mode).
        events: (time, text).
    """

    machine: ContactMachine
    balance: Balance = AS_PLANNED
    time_s: float = 0.0
    changes: list[tuple[float, int, LegMode]] = field(default_factory=list)
    events: list[tuple[float, str]] = field(default_factory=list)

    def run(self, until: float, loaded: Loads, feet: Array = FEET) -> "Script":
        """Tick on to ``until`` with forces as ``loaded`` says."""
        while self.time_s < until - 1e-9:
            modes = self.modes
            forces = 0.25 * WEIGHT * np.array(loaded(self.time_s), dtype=float)
            events = self.machine.update(self.time_s, PERIOD, feet, forces, lambda: self.balance)
            self.events += [(self.time_s, event) for event in events]
            self.changes += [(self.time_s, leg, mode) for leg, mode in enumerate(self.modes) if mode is not modes[leg]]
            self.time_s += PERIOD
        return self

    @property
    def modes(self) -> list[LegMode]:
        """Present mode of each leg."""
        return [leg.mode for leg in self.machine.legs]

    def changes_of(self, leg: int) -> list[tuple[Any, LegMode]]:
        """(time, to one tick, and new mode) of each change of one leg."""
        return [(pytest.approx(time, abs=1.1 * PERIOD), mode) for time, number, mode in self.changes if number == leg]


def loaded_but(leg: int, start: float, end: float) -> Loads:
    """All feet carry load but ``leg`` in [start, end)."""

    def loads(time: float) -> list[bool]:
        return [number != leg or not start - 1e-9 <= time < end - 1e-9 for number in range(4)]

    return loads
