"""Which leg stands, swings or searches: the plan's schedule corrected by what the feet feel."""

import math
from dataclasses import dataclass, field

import numpy as np

from quadlab.controllers.telemetry import LegMode
from quadlab.controllers.tracking.balance import AskForBalance
from quadlab.controllers.tracking.config import SHORTEST_SWING_S, ContactConfig
from quadlab.gaits.schedule import BoolArray, ContactSchedule, Swing
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import LEG_COUNT, LEGS

_EARLY = 0.88  # share of the swing before which a touch-down is reported as early


@dataclass
class LegContact:
    """What the machine remembers of one leg.

    Attributes:
        mode: what the leg is doing.
        foothold: index of the planned foothold that it stands on or left last.
        stance_point: where it touched down, or was measured anew after a slip; of a leg in the air where it lifted off,
            (3,) in [m].
        lift_off_point: where its swing (or search) began, (3,) in [m].
        lift_off_s, touch_down_due_s: plan times of the swing under way in [s]; a hastened swing has those that it would
            have had, had it always had its present pace.
        hastened: whether the swing under way ends at the pace of a fast one.
        touch_down_s: plan time of the last touch-down in [s].
        search_depth: how far a searching foot has been sent down in [m].
        completes_swing: whether the search ends a swing (late) or replaces a lost contact.
        unloaded_s: how long a standing foot has felt no force in [s].
    """

    stance_point: Array
    lift_off_point: Array
    mode: LegMode = LegMode.STANCE
    foothold: int = 0
    lift_off_s: float = 0.0
    touch_down_due_s: float = 0.0
    hastened: bool = False
    touch_down_s: float = -np.inf
    search_depth: float = 0.0
    completes_swing: bool = False
    unloaded_s: float = 0.0

    def swing_phase(self, plan_time_s: float) -> float:
        """Return the progress of the swing under way, from 0; above 1 it is late."""
        return (plan_time_s - self.lift_off_s) / self.swing_duration_s

    @property
    def swing_duration_s(self) -> float:
        """Planned time in the air of the swing under way, at least ``SHORTEST_SWING_S``, in [s]."""
        return max(self.touch_down_due_s - self.lift_off_s, SHORTEST_SWING_S)

    def hasten(self, plan_time_s: float, duration_s: float) -> None:
        """End the swing under way at the pace of one that takes ``duration_s`` in [s]; its phase does not jump."""
        self.lift_off_s = plan_time_s - self.swing_phase(plan_time_s) * duration_s
        self.touch_down_due_s = self.lift_off_s + duration_s
        self.hastened = True


@dataclass
class ContactMachine:
    """Follows the schedule leg by leg; early and late touch-down, lost contact, lift-off that must wait.

    A leg that the balance cannot spare stays on the ground, or comes back to it at the pace of a fast swing.

    Attributes:
        config: thresholds.
        schedule: of the plan.
        touch_down_force: normal force that means contact in [N].
        legs: what is remembered of each.
        events: of the last tick, one line each.
    """

    config: ContactConfig
    schedule: ContactSchedule
    touch_down_force: float
    legs: list[LegContact]
    events: list[str] = field(default_factory=list)
    _balance: AskForBalance | None = field(init=False, default=None)

    @property
    def stance(self) -> BoolArray:
        """Which legs stand, (4,)."""
        return np.array([leg.mode is LegMode.STANCE for leg in self.legs])

    @property
    def stance_points(self) -> Array:
        """Where each leg stands, or lifted off if it is in the air, (4, 3) in [m]."""
        return np.array([leg.stance_point for leg in self.legs])

    @property
    def searching(self) -> bool:
        """Whether a leg is past its planned touch-down or has lost its contact."""
        return any(leg.mode is LegMode.SEARCH for leg in self.legs)

    def update(
        self,
        plan_time_s: float,
        period_s: float,
        feet: Array,
        normal_forces: Array,
        balance: AskForBalance | None = None,
    ) -> list[str]:
        """Advance by one tick and return what happened, one line an event.

        Args:
            plan_time_s: time in the plan in [s].
            period_s: control period in [s].
            feet: contact points of all feet in the world, (4, 3) in [m].
            normal_forces: measured, (4,) in [N].
            balance: tells the robot's balance, which few ticks depend on; None takes it for kept.
        """
        self.events = []
        self._balance = balance
        for leg in range(LEG_COUNT):
            touches = bool(normal_forces[leg] > self.touch_down_force)
            completed, swing = self.schedule.swing_at(leg, plan_time_s)
            if self.legs[leg].mode is LegMode.STANCE:
                self._stand(leg, plan_time_s, completed, swing, feet[leg])
                self._watch_load(leg, plan_time_s, period_s, touches, feet[leg])
            else:
                self._fly(leg, plan_time_s, touches, feet[leg])
                self._search(leg, plan_time_s, period_s, completed, swing, feet[leg])
        return self.events

    def follow(self, schedule: ContactSchedule, elapsed_s: float, feet: Array) -> None:
        """Go on with a new schedule; its time 0 is the time ``elapsed_s`` of the old one in [s].

        Legs keep their modes; each has the first foothold of the new plan under it, or has left it. Stance points are
        measured anew, since a round foot has rolled on from where it touched down; those of searching legs keep their
        height.

        Args:
            schedule: in which a leg in the air has the rest of its swing first.
            elapsed_s: plan time now in [s].
            feet: contact points now, (4, 3) in [m].
        """
        self.schedule = schedule
        for number, leg in enumerate(self.legs):
            leg.foothold = 0
            leg.touch_down_s -= elapsed_s
            leg.lift_off_s -= elapsed_s
            leg.touch_down_due_s -= elapsed_s
            leg.completes_swing = False
            if leg.mode is LegMode.STANCE:
                leg.stance_point = feet[number].copy()
            elif leg.mode is LegMode.SEARCH:
                leg.stance_point = np.array([*feet[number, :2], leg.stance_point[2]])

    def _others_standing(self, leg: int) -> int:
        return sum(other.mode is LegMode.STANCE for i, other in enumerate(self.legs) if i != leg)

    def _stand(self, leg: int, time_s: float, completed: int, swing: Swing | None, foot: Array) -> None:
        """Slip, lift off when due, skip what came too late."""
        state = self.legs[leg]
        if math.dist(foot.tolist(), state.stance_point.tolist()) > self.config.slip_m:
            state.stance_point = foot
        if swing is None:
            if state.foothold < completed:
                self._skip(leg, completed)
        elif state.foothold == completed:
            if self._may_lift_off(leg, time_s):
                self._lift_off(leg, time_s, swing.end_s, foot)
            elif self._too_late(swing, time_s):
                self._skip(leg, completed + 1)
        elif state.foothold < completed:
            self._skip(leg, completed)

    def _watch_load(self, leg: int, time_s: float, period_s: float, touches: bool, foot: Array) -> None:
        """Send a leg that stands on nothing in search of the ground, if enough others stand."""
        state = self.legs[leg]
        if state.mode is not LegMode.STANCE:
            return
        state.unloaded_s = 0.0 if touches else state.unloaded_s + period_s
        lost = state.unloaded_s > self.config.lost_contact_s
        settled = time_s - state.touch_down_s > self.config.settling_s
        if lost and settled and self._others_standing(leg) >= self.config.minimum_stance_legs:
            self._begin_search(leg, foot, completes_swing=False)
            self._note(leg, "lost contact")

    def _fly(self, leg: int, time_s: float, touches: bool, foot: Array) -> None:
        """Touch down, early, in time or late."""
        state = self.legs[leg]
        if state.mode is LegMode.SWING:
            self._hasten_if_needed(leg, time_s)
        phase = state.swing_phase(time_s)
        if touches and (state.mode is LegMode.SEARCH or phase > self.config.earliest_touch_down):
            self._touch_down(leg, time_s, foot)
        elif phase >= 1.0 and state.mode is LegMode.SWING:
            self._begin_search(leg, foot, completes_swing=True)
            self._note(leg, "late: no touch-down at the end of the swing")

    def _search(
        self, leg: int, time_s: float, period_s: float, completed: int, swing: Swing | None, foot: Array
    ) -> None:
        """Reach down; join the next swing if its time has come."""
        state = self.legs[leg]
        if state.mode is not LegMode.SEARCH:
            return
        state.search_depth += self.config.search_speed_mps * period_s
        reached = state.foothold + (1 if state.completes_swing else 0)
        if swing is not None and reached == completed:
            state.foothold = completed
            self._lift_off(leg, time_s, swing.end_s, foot)

    def _may_lift_off(self, leg: int, time_s: float) -> bool:
        """Whether enough others stand, among them all that the plan counts on: not any two legs can carry a trot."""
        complete = all(self.legs[other].mode is LegMode.STANCE for other in self._counted_on_besides(leg, time_s))
        enough = self._others_standing(leg) >= self.config.minimum_stance_legs
        return complete and enough and self._can_spare(leg, time_s)

    def _counted_on_besides(self, leg: int, time_s: float) -> list[int]:
        """Return the other legs that stand by plan."""
        others = [other for other in range(LEG_COUNT) if other != leg]
        return [other for other in others if self.schedule.swing_at(other, time_s)[1] is None]

    def _can_spare(self, leg: int, time_s: float) -> bool:
        """Whether the other legs that stand by plan keep the balance."""
        margin = self.config.capture_margin_m
        if margin is None or self._balance is None:
            return True
        return self._balance().held_by(self._counted_on_besides(leg, time_s), margin)

    def _hasten_if_needed(self, leg: int, time_s: float) -> None:
        state, duration_s = self.legs[leg], self.config.hastened_swing_s
        slow = state.swing_duration_s > duration_s and not state.hastened
        if not slow or state.swing_phase(time_s) >= 1.0 or self._can_spare(leg, time_s):
            return
        self._note(leg, f"hastens at {state.swing_phase(time_s):.2f} of the swing")
        state.hasten(time_s, duration_s)

    def _too_late(self, swing: Swing, time_s: float) -> bool:
        return time_s > swing.start_s + self.config.latest_lift_off * swing.duration_s

    def _lift_off(self, leg: int, time_s: float, due_s: float, foot: Array) -> None:
        state = self.legs[leg]
        if state.mode is LegMode.STANCE:
            state.stance_point = foot
        state.mode = LegMode.SWING
        state.lift_off_point = foot
        state.lift_off_s = time_s
        state.hastened = False
        state.touch_down_due_s = time_s + self.config.expected_touch_down * (due_s - time_s)

    def _touch_down(self, leg: int, time_s: float, foot: Array) -> None:
        state = self.legs[leg]
        if state.mode is LegMode.SWING or state.completes_swing:
            state.foothold += 1
        if state.mode is LegMode.SEARCH:
            self._note(leg, f"ground found {1e3 * state.search_depth:.0f} mm down")
        elif state.swing_phase(time_s) < _EARLY:
            self._note(leg, f"early touch-down at {state.swing_phase(time_s):.2f} of the swing")
        state.mode = LegMode.STANCE
        state.stance_point = foot
        state.touch_down_s = time_s
        state.unloaded_s = 0.0

    def _begin_search(self, leg: int, foot: Array, completes_swing: bool) -> None:
        state = self.legs[leg]
        state.mode = LegMode.SEARCH
        state.lift_off_point = foot
        state.search_depth = 0.0
        state.completes_swing = completes_swing
        state.unloaded_s = 0.0

    def _skip(self, leg: int, foothold: int) -> None:
        self.legs[leg].foothold = foothold
        self._note(leg, "swing skipped")

    def _note(self, leg: int, text: str) -> None:
        self.events.append(f"{LEGS[leg]} {text}")


def start_contacts(config: ContactConfig, schedule: ContactSchedule, weight: float, feet: Array) -> ContactMachine:
    """Return a machine with all feet standing where they are.

    Args:
        config: thresholds.
        schedule: of the plan.
        weight: of the robot in [N].
        feet: contact points in the world, (4, 3) in [m].
    """
    legs = [LegContact(stance_point=foot.copy(), lift_off_point=foot.copy()) for foot in feet]
    return ContactMachine(config, schedule, config.touch_down_force_share * weight, legs)
