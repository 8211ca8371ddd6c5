"""Everything that makes one robot differ from another, as it stands in ``conf/robot/*.yaml``."""

from typing import Annotated, TypeVar

from pydantic import Field, field_validator

from quadlab.configuration import NonNegative, Positive, StrictModel, Vector2, Vector3
from quadlab.robots.legs import LEGS

_Value = TypeVar("_Value")
PositionRange = Annotated[tuple[float, ...], Field(min_length=2, max_length=2)]


class DescriptionOverrides(StrictModel):
    """Values that replace those of the URDF; keys of joints are regular expressions that match the whole name.

    Attributes:
        mass_kg: new mass by link name in [kg]; the link's rotational inertia scales with it.
        effort_nm: torque limit by joint in [N m].
        velocity_radps: speed limit by joint in [rad/s]; monitored, not enforced by the simulation.
        position_rad: lower and upper limit by joint in [rad].
        damping_nms: viscous friction by joint in [N m s/rad].
        friction_nm: dry friction by joint in [N m].
    """

    mass_kg: dict[str, Positive] = Field(default_factory=dict)
    effort_nm: dict[str, Positive] = Field(default_factory=dict)
    velocity_radps: dict[str, Positive] = Field(default_factory=dict)
    position_rad: dict[str, PositionRange] = Field(default_factory=dict)
    damping_nms: dict[str, NonNegative] = Field(default_factory=dict)
    friction_nm: dict[str, NonNegative] = Field(default_factory=dict)


class RobotConfig(StrictModel):
    """One robot: where its URDF is, what the URDF calls the parts we need, and what the URDF leaves open.

    Names of joints and links are templates in which ``{leg}`` stands for the URDF's name of the leg.

    Attributes:
        name: of the robot.
        urdf: path below the ``robots`` folder of the package example-robot-data, or an absolute path.
        base_link: the root link of the URDF.
        legs: what the URDF calls each leg, e.g. ``{LF: FL, ...}``.
        joints: templates of the joint names in the order HAA, HFE, KFE.
        foot_link: template of the foot link's name.
        foot_center_m: centre of the spherical foot in the frame of the foot link, (3,) in [m].
        foot_radius_m: in [m].
        nominal_joints_rad: HAA, HFE, KFE of each leg when standing, in [rad].
        reach_m: half box in which the planner may move a foot, forward and sideways in [m].
        armature_kgm2: reflected rotor inertia of HAA, HFE, KFE in [kg m^2], in both models.
        base_box_m: edge lengths of a collision box around the base's origin, for a URDF whose base has no
            primitive collision shape, in [m].
        overrides: values that replace those of the URDF.
    """

    name: str
    urdf: str
    base_link: str
    legs: dict[str, str]
    joints: Annotated[tuple[str, ...], Field(min_length=3, max_length=3)]
    foot_link: str
    foot_center_m: Vector3
    foot_radius_m: Positive
    nominal_joints_rad: dict[str, Vector3]
    reach_m: Vector2
    armature_kgm2: Annotated[tuple[NonNegative, ...], Field(min_length=3, max_length=3)]
    base_box_m: Vector3 | None = None
    overrides: DescriptionOverrides = DescriptionOverrides()

    @field_validator("legs", "nominal_joints_rad")
    @classmethod
    def _has_every_leg(cls, by_leg: dict[str, _Value]) -> dict[str, _Value]:
        if set(by_leg) != set(LEGS):
            raise ValueError(f"expected the legs {', '.join(LEGS)}; got {', '.join(by_leg)}")
        return by_leg

    @field_validator("legs")
    @classmethod
    def _legs_differ(cls, legs: dict[str, str]) -> dict[str, str]:
        if len(set(legs.values())) < len(legs):
            raise ValueError(f"expected a name of its own for each leg; got {', '.join(legs.values())}")
        return legs


def joint_names_in_urdf(config: RobotConfig) -> tuple[str, ...]:
    """Return what the URDF calls the joints, in the order ``JOINT_NAMES``, (12,)."""
    return tuple(template.replace("{leg}", config.legs[leg]) for leg in LEGS for template in config.joints)


def foot_links_in_urdf(config: RobotConfig) -> tuple[str, ...]:
    """Return what the URDF calls the foot links, in the order ``LEGS``, (4,)."""
    return tuple(config.foot_link.replace("{leg}", config.legs[leg]) for leg in LEGS)
