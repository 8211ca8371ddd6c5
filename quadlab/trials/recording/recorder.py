"""Recording of a trial into one MCAP file."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from enum import Enum
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log

from quadlab.errors import LogError
from quadlab.planners.plan import MotionPlan
from quadlab.planners.plan_io import plan_to_bytes
from quadlab.simulation.geom_description import GeomDescription
from quadlab.trials.recording import topics
from quadlab.trials.recording.columns import (
    CONTROL_BLOCKS,
    ESTIMATE_BLOCKS,
    STATE_BLOCKS,
    TIMING_BLOCKS,
    Block,
    level_blocks,
)
from quadlab.trials.recording.config import LogConfig
from quadlab.trials.recording.log_file import LogFile, nanoseconds
from quadlab.trials.recording.primitives import stamp
from quadlab.trials.recording.record import BodyPoses, TickRecord
from quadlab.trials.recording.scene_writer import SceneWriter
from quadlab.trials.recording.tick_packer import TickPacker

Attachments = Mapping[str, tuple[str, bytes]]
"""Content type and content by file name, e.g. {"config.yaml": ("text/yaml", b"...")}."""

_KIBIBYTE = 1024


class EventLevel(Enum):
    """How much an event matters."""

    DEBUG = Log.DEBUG
    INFO = Log.INFO
    WARNING = Log.WARNING
    ERROR = Log.ERROR


class TrialRecorder:
    """Writes ``<path>.part`` while the trial runs and renames it to ``path`` at the end.

    As a context manager it closes the log at the end of the block; if the block raises, the part file stays and
    ``recover.recover_log`` makes a log of it. The same records, attachments and metadata give the same bytes.
    """

    def __init__(
        self,
        path: Path,
        config: LogConfig,
        *,
        level_names: Sequence[str],
        plan: MotionPlan,
        geoms: Sequence[GeomDescription],
        attachments: Attachments,
        metadata: Mapping[str, str],
        estimates: bool = False,
    ) -> None:
        """Create the part file and write what is known before the first tick.

        Args:
            path: the log, usually ``trial.mcap``; an older one is replaced when the new one is complete.
            config: rates and sizes.
            level_names: of the controller, highest priority first; keys of ``level_residuals``.
            plan: drawn, and attached as ``plan.npz``.
            geoms: shapes of the robot and of its surroundings (body "world").
            attachments: further files that belong to the trial.
            metadata: a few words for listings, e.g. trial id and robot.
            estimates: whether every tick carries the estimate of a filter; it gets a topic of its own.

        Raises:
            LogError: if two levels have the same column name, or ``attachments`` holds a ``plan.npz`` too.
        """
        if topics.PLAN_ATTACHMENT in attachments:
            raise LogError(f"attachment '{topics.PLAN_ATTACHMENT}': the recorder adds it itself; use another name")
        blocks = _blocks(level_names, config, estimates)
        self._level_names = frozenset(level_names)
        self._pushed = False
        self._waiting: list[TickRecord] = []
        self._file = LogFile(path, part_path(path), config.chunk_size_kib * _KIBIBYTE)
        plan_file = ("application/zip", plan_to_bytes(plan if config.wall_times else _without_wall_times(plan)))
        self._attach({**attachments, topics.PLAN_ATTACHMENT: plan_file}, metadata)
        self._packers = [self._packer(topic, name, rows) for topic, (name, rows) in blocks.items()]
        self._events = self._file.add_foxglove_channel(topics.EVENTS, Log)
        self._scene = SceneWriter(self._file, config.scene_rate_hz, plan, geoms)

    def draws(self, time_s: float) -> bool:
        """Return whether a tick at ``time_s`` in [s] is drawn and needs the poses of the bodies."""
        return self._scene.is_due(nanoseconds(time_s))

    def record(self, tick: TickRecord, bodies: BodyPoses | None) -> None:
        """Take in one tick: its scalars always, what is drawn at the scene rate.

        Ticks are written when one is drawn: many in a row, which takes half the time of one after each control tick.

        Args:
            tick: one control tick.
            bodies: at the start of the tick; None if the tick is not drawn, see ``draws``.

        Raises:
            LogError: if the telemetry has a level that was not announced, or ``bodies`` is missing.
        """
        unknown = tick.telemetry.level_residuals.keys() - self._level_names
        if unknown:
            raise LogError(f"unknown level '{min(unknown)}'; announced: {', '.join(sorted(self._level_names))}")
        drawn = self.draws(tick.state.time_s)
        if drawn and bodies is None:
            raise LogError(f"the tick at {tick.state.time_s:g} s is drawn and needs the poses of the bodies")
        self._waiting.append(tick)
        if drawn and bodies is not None:
            self._write_waiting(bodies)

    def _write_waiting(self, bodies: BodyPoses | None = None) -> None:
        """Write the ticks since the last drawing; the last of them is drawn if there are ``bodies``."""
        waiting, self._waiting = self._waiting, []
        for number, tick in enumerate(waiting, start=1):
            time_ns = nanoseconds(tick.state.time_s)
            if bodies is not None and number == len(waiting):
                self._scene.draw(tick, bodies, time_ns)
            for channel, packer in self._packers:
                self._file.write(channel, time_ns, packer.pack(tick))
            for message in tick.telemetry.events:
                self._write_event(time_ns, message, EventLevel.INFO)
            self._record_push(tick)

    def event(self, time_s: float, message: str, level: EventLevel = EventLevel.INFO) -> None:
        """Write that something happened at ``time_s`` in [s]."""
        self._write_waiting()
        self._write_event(nanoseconds(time_s), message, level)

    def _write_event(self, time_ns: int, message: str, level: EventLevel) -> None:
        entry = Log(timestamp=stamp(time_ns), level=level.value, message=message, name="trial")
        self._file.write(self._events, time_ns, entry.SerializeToString(deterministic=True))

    def close(self) -> None:
        """Complete the log and give it its name."""
        self._write_waiting()
        self._file.finish()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            try:
                self._write_waiting()
            finally:
                self._file.abandon()

    def _record_push(self, tick: TickRecord) -> None:
        if bool(tick.pushes) == self._pushed:
            return
        self._pushed = bool(tick.pushes)
        total = float(np.linalg.norm(np.sum([force for _, force in tick.pushes], axis=0)))
        message = f"push of {total:.1f} N starts" if self._pushed else "push ends"
        self._write_event(nanoseconds(tick.state.time_s), message, EventLevel.INFO)

    def _packer(self, topic: str, type_name: str, blocks: Sequence[Block]) -> tuple[int, TickPacker]:
        packer = TickPacker(type_name, blocks)
        return self._file.add_channel(topic, packer.type.full_name, packer.type.descriptor_set), packer

    def _attach(self, attachments: Attachments, metadata: Mapping[str, str]) -> None:
        for name, (media_type, data) in attachments.items():
            self._file.writer.add_attachment(0, 0, name, media_type, data)
        self._file.writer.add_metadata(topics.TRIAL_METADATA, dict(metadata))


def part_path(path: Path) -> Path:
    """Return where the log ``path`` is while it is being written."""
    return path.with_name(path.name + topics.PART_SUFFIX)


def _blocks(level_names: Sequence[str], config: LogConfig, estimates: bool) -> dict[str, tuple[str, tuple[Block, ...]]]:
    blocks = {topics.STATE: ("State", STATE_BLOCKS), topics.CONTROL: ("Control", CONTROL_BLOCKS)}
    if estimates:
        blocks[topics.ESTIMATE] = ("Estimate", ESTIMATE_BLOCKS)
    if level_names:
        blocks[topics.LEVELS] = ("Levels", level_blocks(level_names))
    if config.wall_times:
        blocks[topics.TIMING] = ("Timing", TIMING_BLOCKS)
    return blocks


def _without_wall_times(plan: MotionPlan) -> MotionPlan:
    return replace(plan, report=replace(plan.report, build_ms=0.0, solve_ms=0.0))
