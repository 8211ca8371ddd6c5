"""What the configurations of all controllers that track a plan have in common."""

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.controllers.tracking.config import TrackingConfig


class JointPdConfig(StrictModel):
    """Drives that correct the torques at the rate of the physics, towards the motion that the controller expects.

    Attributes:
        proportional_nm_per_rad: in [N m/rad].
        derivative_nms_per_rad: in [N m s/rad]; a drive is stable only below about twice the joint's inertia over its
            period.
    """

    proportional_nm_per_rad: NonNegative
    derivative_nms_per_rad: NonNegative


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
    joint_pd: JointPdConfig | None
