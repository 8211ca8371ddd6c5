"""Names and order of legs and leg joints; every array over legs in quadlab has this order."""

LEGS = ("LF", "RF", "LH", "RH")
"""Left fore, right fore, left hind, right hind: the papers' order."""

LEG_COUNT = len(LEGS)
JOINTS_PER_LEG = 3
JOINT_COUNT = LEG_COUNT * JOINTS_PER_LEG

LEG_JOINTS = ("HAA", "HFE", "KFE")
"""Hip abduction/adduction, hip flexion/extension, knee flexion/extension."""

JOINT_NAMES = tuple(f"{leg}_{joint}" for leg in LEGS for joint in LEG_JOINTS)
"""Joint names in quadlab's order, (12,); a robot maps them to the names of its URDF."""


def leg_index(leg: str) -> int:
    """Return the position of ``leg`` in arrays over legs."""
    return LEGS.index(leg)


def joints_of(leg: int) -> slice:
    """Return the slice of leg number ``leg`` in arrays over the 12 joints."""
    return slice(JOINTS_PER_LEG * leg, JOINTS_PER_LEG * (leg + 1))


def foot_names(count: int) -> tuple[str, ...]:
    """Return what ``count`` feet are called: the legs of a quadruped, numbers otherwise."""
    return LEGS if count == LEG_COUNT else tuple(f"foot {number}" for number in range(count))
