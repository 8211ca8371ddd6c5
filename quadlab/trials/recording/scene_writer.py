"""The part of a log that is drawn: written at the scene rate, in Foxglove's message types."""

from collections.abc import Sequence
from typing import Any

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from quadlab.planners.plan import MotionPlan
from quadlab.simulation.geom_description import GeomDescription
from quadlab.trials.recording import topics
from quadlab.trials.recording.geom_scene import geom_scene
from quadlab.trials.recording.log_file import NANOSECONDS, LogFile
from quadlab.trials.recording.plan_scene import plan_scene
from quadlab.trials.recording.record import BodyPoses, TickRecord
from quadlab.trials.recording.tick_scene import forces, joint_states, reference, transforms

SCENE_TOPICS = {
    topics.TRANSFORMS: FrameTransforms,
    topics.JOINT_STATES: JointStates,
    topics.FORCES: SceneUpdate,
    topics.REFERENCE: SceneUpdate,
    topics.PLAN: SceneUpdate,
    topics.MODEL: SceneUpdate,
    topics.TERRAIN: SceneUpdate,
}


class SceneWriter:
    """Draws a tick when it is time to."""

    def __init__(self, file: LogFile, rate_hz: float, plan: MotionPlan, geoms: Sequence[GeomDescription]) -> None:
        """Register the channels in ``file``; ``plan`` and ``geoms`` are drawn with the first tick."""
        self._file = file
        self._period_ns = round(NANOSECONDS / rate_hz)
        self._due_ns: int | None = None
        self._plan = plan
        self._terrain = [geom for geom in geoms if geom.body == topics.WORLD_FRAME]
        self._robot = [geom for geom in geoms if geom.body != topics.WORLD_FRAME]
        self._channels = {topic: file.add_foxglove_channel(topic, kind) for topic, kind in SCENE_TOPICS.items()}

    def is_due(self, time_ns: int) -> bool:
        """Return whether a period has passed at ``time_ns`` since the last tick that was drawn."""
        return self._due_ns is None or time_ns >= self._due_ns

    def draw(self, tick: TickRecord, bodies: BodyPoses, time_ns: int) -> None:
        """Draw ``tick``; the next one is due a period later."""
        self._draw(topics.TRANSFORMS, transforms(tick, bodies, time_ns), time_ns)
        if self._due_ns is None:  # after /tf: viewers place locked shapes by the transforms they have seen so far
            self._due_ns = time_ns
            self._draw_once(time_ns)
        self._due_ns += self._period_ns
        self._draw(topics.JOINT_STATES, joint_states(tick, time_ns), time_ns)
        self._draw(topics.FORCES, forces(tick, time_ns), time_ns)
        self._draw(topics.REFERENCE, reference(tick, time_ns), time_ns)
        self._file.flush()

    def _draw_once(self, time_ns: int) -> None:
        self._draw(topics.MODEL, geom_scene(self._robot, time_ns), time_ns)
        self._draw(topics.TERRAIN, geom_scene(self._terrain, time_ns), time_ns)
        self._draw(topics.PLAN, plan_scene(self._plan, time_ns), time_ns)

    def _draw(self, topic: str, message: Any, time_ns: int) -> None:
        self._file.write(self._channels[topic], time_ns, message.SerializeToString(deterministic=True))
