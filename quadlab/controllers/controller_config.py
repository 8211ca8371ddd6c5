"""What the configurations of all controllers that track a plan have in common."""

from typing import Annotated, Literal

from pydantic import PlainSerializer

from quadlab.configuration import NonNegative, Positive, StrictModel, without_defaults
from quadlab.controllers.tracking.config import TrackingConfig


class JointPdConfig(StrictModel):
    """Drives that correct the torques at the rate of the physics, towards the motion that the controller expects.

    Attributes:
        proportional_nm_per_rad: in [N m/rad].
        derivative_nms_per_rad: in [N m s/rad]; a drive is stable only below about twice the joint's inertia over its
            period.
        swing_torques: what the drives of legs in the air correct: the torques that were ``solved`` for, or those that
            ``hold`` the joints without acceleration. The second is for controllers that leave these legs to the
            drives (Gehring 2017, III-C e): their hierarchy bends a swing leg to turn the base about two standing
            feet, and the drives would work against it.
    """

    proportional_nm_per_rad: NonNegative
    derivative_nms_per_rad: NonNegative
    swing_torques: Literal["solved", "hold"] = "solved"


class TrackingControllerConfig(StrictModel):
    """Rate, tracking and drives.

    Attributes:
        name: of the controller in results; several files may be of one kind.
        rate_hz: control rate in [1/s].
        tracking: everything between plan and tasks.
        joint_pd: of the drives; null for torque control alone.
    """

    name: str
    rate_hz: Positive
    tracking: TrackingConfig
    joint_pd: Annotated[JointPdConfig, PlainSerializer(without_defaults, return_type=dict)] | None
