"""Settings of all between plan and tasks; lengths without a unit are shares of the robot's standing base height."""

from enum import StrEnum
from typing import Self

from pydantic import Field, model_validator

from quadlab.configuration import Fraction, NonNegative, Positive, StrictModel
from quadlab.robots.legs import LEG_COUNT

SHORTEST_SWING_S = 0.05
"""A swing that begins late still takes so long, in [s]."""


class Alignment(StrEnum):
    """Where the plan is taken to be (Gehring 2017, III-A, Fig. 2)."""

    NONE = "none"
    """Where it was at the start."""
    BASE = "base"
    """Its planned base over the measured base."""
    FEET = "feet"
    """Its planned feet over the measured feet."""


class AlignmentConfig(StrictModel):
    """Which alignment serves what.

    Attributes:
        torso: for the torso's reference.
        swing: for the footholds of swinging legs.
        time_constant_s: of the filter of the torso's alignment, which jumps at new footholds if it is feet-centred; in
            [s]. Footholds have the same filter if both are feet-centred, and none otherwise.
    """

    torso: Alignment
    swing: Alignment
    time_constant_s: Positive


class ContactConfig(StrictModel):
    """When a leg counts as standing.

    Attributes:
        touch_down_force_share: normal force that means contact, as a share of the robot's weight.
        earliest_touch_down: share of the swing before which a contact is ignored.
        expected_touch_down: share of the swing at which the foot reaches the ground it expects; from then on it
            searches.
        latest_lift_off: share of a swing after which a lift-off that had to wait is skipped.
        capture_margin_m: a leg is spared only while the capture point is so far inside the support of the legs that
            stand by plan, or so near the planned one, in [m]: before, its lift-off waits; after, its swing hastens.
            None never looks at it.
        hastened_swing_s: duration of a swing at whose pace a hastened one ends, at least ``SHORTEST_SWING_S``, in [s].
        minimum_stance_legs: a leg lifts off only if so many others stand, and all that shall stand by plan; one that
            lost its contact searches only if so many others stand.
        lost_contact_s: time without force after which a standing leg searches the ground in [s].
        settling_s: time after touch-down in which lost contact is ignored in [s].
        search_speed_mps: how fast a searching foot goes down in [m/s].
        slip_m: motion of a standing foot beyond which its stance point is measured anew in [m].
        freeze_plan_while_searching: let the plan's clock run down while a late foot, or one that has lost its contact,
            looks for the ground.
    """

    touch_down_force_share: Positive
    earliest_touch_down: Fraction
    expected_touch_down: Fraction
    latest_lift_off: Fraction
    capture_margin_m: Positive | None
    hastened_swing_s: float = Field(ge=SHORTEST_SWING_S)
    minimum_stance_legs: int = Field(ge=0, lt=LEG_COUNT)
    lost_contact_s: Positive
    settling_s: NonNegative
    search_speed_mps: Positive
    slip_m: Positive
    freeze_plan_while_searching: bool


class SwingConfig(StrictModel):
    """How a foot travels to its foothold.

    Attributes:
        apex: height of the arc over the higher of its ends.
        depth: how far below the ground the foot aims, so that it is felt.
        feedback: gain on sqrt(h / g) (v - v_ref), the inverted-pendulum foothold correction, dimensionless.
        feedback_speed_limit_mps: largest speed error that the correction answers in [m/s].
        reach_forward, reach_sideways: how far a foothold may be from the leg's nominal position.
    """

    apex: Positive
    depth: NonNegative
    feedback: NonNegative
    feedback_speed_limit_mps: Positive
    reach_forward: Positive
    reach_sideways: Positive


class ForceRampConfig(StrictModel):
    """Normal-force limits over a stance phase (Gehring 2017, III-C b).

    Attributes:
        share_of_stance: part of the stance phase over which the limit rises, and falls at its end.
        maximum_weight_share: limit in between, as a share of the robot's weight.
        initial_weight_share: limit at the moment of touch-down, as a share of the robot's weight.
    """

    share_of_stance: Fraction
    maximum_weight_share: Positive
    initial_weight_share: NonNegative

    @model_validator(mode="after")
    def _limit_rises(self) -> Self:
        if self.initial_weight_share > self.maximum_weight_share:
            raise ValueError(
                f"initial_weight_share must not be above maximum_weight_share; are {self.initial_weight_share:g} and "
                f"{self.maximum_weight_share:g}"
            )
        return self


class TorsoReference(StrEnum):
    """What the base is to follow; the CoM always follows the plan."""

    COM = "com"
    """The planned CoM, over which it is laid as in the nominal stance, at standing height."""
    BASE = "base"
    """The planned base (Gehring 2017, III-C) of planners that plan it; with others as ``COM``."""


class TorsoConfig(StrictModel):
    """How the torso follows plan and ground.

    Attributes:
        reference: what position, height and attitude follow.
        slope_following: share of the terrain's slope that roll and pitch follow.
        terrain_time_constant_s: of the filter on the terrain plane in [s].
    """

    reference: TorsoReference
    slope_following: Fraction
    terrain_time_constant_s: Positive


class TrackingConfig(StrictModel):
    """All of it."""

    alignment: AlignmentConfig
    contact: ContactConfig
    swing: SwingConfig
    force_ramp: ForceRampConfig
    torso: TorsoConfig
