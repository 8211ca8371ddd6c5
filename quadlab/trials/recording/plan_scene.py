"""The motion plan as scene entities in its own frame, drawn once."""

from itertools import pairwise

import numpy as np
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from quadlab.geometry.curve import Curve
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.planners.swing import swing_blend
from quadlab.robots.legs import LEGS
from quadlab.trials.recording.primitives import LEG_COLOURS, Rgba, entity, polyline, sphere
from quadlab.trials.recording.topics import PLAN_FRAME

_SAMPLE_PERIOD = 0.02  # [s]
_ARC_SAMPLES = 12
_ARC_HEIGHT = 0.08  # [m], for the eye: plans hold footholds, the controller shapes the swing
_LINE, _MARK = 0.006, 0.03  # [m]
_COM_COLOUR: Rgba = (0.95, 0.75, 0.10, 0.9)
_COP_COLOUR: Rgba = (0.90, 0.10, 0.10, 0.6)


def plan_scene(plan: MotionPlan, time_ns: int) -> SceneUpdate:
    """Return the lines of CoM and CoP and, for each leg in its colour, its footholds and the arcs between them."""
    motion = entity("plan/motion", PLAN_FRAME, time_ns, frame_locked=True)
    motion.lines.append(polyline(_sampled(plan.com, plan.duration_s), _LINE, _COM_COLOUR))
    cop = _sampled(plan.cop, plan.duration_s)
    motion.lines.append(polyline(np.pad(cop, ((0, 0), (0, 1))), _LINE, _COP_COLOUR))
    legs = [_leg_entity(leg, footholds, time_ns) for leg, footholds in enumerate(plan.footholds)]
    return SceneUpdate(entities=[motion, *legs])


def swing_arc(start: Array, end: Array) -> Array:
    """Return points, (n, 3) in [m], of an arc between two footholds (3,)."""
    share = np.linspace(0.0, 1.0, _ARC_SAMPLES)
    blend = swing_blend(share)[:, None]
    arc = (1.0 - blend) * start + blend * end
    arc[:, 2] += _ARC_HEIGHT * 4.0 * share * (1.0 - share)
    return arc


def _leg_entity(leg: int, footholds: Array, time_ns: int) -> SceneEntity:
    target = entity(f"plan/{LEGS[leg]}", PLAN_FRAME, time_ns, frame_locked=True)
    target.spheres.extend(sphere(foothold, _MARK, LEG_COLOURS[leg]) for foothold in footholds)
    arcs = [swing_arc(start, end) for start, end in pairwise(footholds)]
    if arcs:
        target.lines.append(polyline(np.concatenate(arcs), 0.5 * _LINE, LEG_COLOURS[leg]))
    return target


def _sampled(curve: Curve, duration_s: float) -> Array:
    times = np.append(np.arange(0.0, duration_s, _SAMPLE_PERIOD), duration_s)
    return np.array([curve(float(time)) for time in times])
