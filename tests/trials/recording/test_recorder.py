"""What a trial log promises to the tools that open it."""

import os
from pathlib import Path

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap_protobuf.decoder import DecoderFactory
from synthetic_records import (
    ATTACHMENTS,
    BODIES,
    LEVELS,
    METADATA,
    body_poses,
    log_config,
    recorder,
    tick_record,
    write_interrupted_log,
    write_log,
)

from quadlab.errors import LogError
from quadlab.trials.recording import topics
from quadlab.trials.recording.recorder import EventLevel, part_path

MODEL_TOPICS = (topics.MODEL, topics.TERRAIN, topics.PLAN)


def test_equal_records_give_equal_bytes(tmp_path: Path) -> None:
    first, second = write_log(tmp_path / "a.mcap"), write_log(tmp_path / "b.mcap")
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(("wall_times", "equal"), [(True, False), (False, True)])
def test_only_computing_times_differ_between_reruns(tmp_path: Path, wall_times: bool, equal: bool) -> None:
    config = log_config(wall_times=wall_times)
    first = write_log(tmp_path / "a.mcap", config=config, wall_time_us=80.0)
    second = write_log(tmp_path / "b.mcap", config=config, wall_time_us=120.0)
    assert (first.read_bytes() == second.read_bytes()) is equal


def test_log_has_its_name_only_when_it_is_complete(tmp_path: Path) -> None:
    path = tmp_path / "trial.mcap"
    log = recorder(path, log_config())
    log.record(tick_record(0), body_poses(0))
    assert part_path(path).exists()
    assert not path.exists()
    log.close()
    assert path.exists()
    assert not part_path(path).exists()


def test_log_is_on_the_disk_before_it_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    synced: list[int] = []

    def note(descriptor: int) -> None:
        assert not (tmp_path / "trial.mcap").exists()
        synced.append(os.fstat(descriptor).st_size)

    monkeypatch.setattr(os, "fsync", note)
    log = write_log(tmp_path / "trial.mcap", ticks=3)
    assert synced == [log.stat().st_size]


def test_an_exception_leaves_the_part_file(tmp_path: Path) -> None:
    path = tmp_path / "trial.mcap"
    assert write_interrupted_log(path, ticks=1).exists()
    assert not path.exists()


def test_every_channel_has_a_schema_and_the_summary_counts_the_messages(tmp_path: Path) -> None:
    with write_log(tmp_path / "trial.mcap", ticks=80).open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    counts = {c.topic: summary.statistics.channel_message_counts.get(c.id, 0) for c in summary.channels.values()}
    assert all(channel.schema_id in summary.schemas for channel in summary.channels.values())
    assert counts[topics.STATE] == counts[topics.CONTROL] == counts[topics.LEVELS] == 80
    assert counts[topics.TRANSFORMS] == counts[topics.FORCES] == counts[topics.REFERENCE] == 10
    assert [counts[topic] for topic in MODEL_TOPICS] == [1, 1, 1]


def test_attachments_come_before_all_messages(tmp_path: Path) -> None:
    with write_log(tmp_path / "trial.mcap", ticks=20).open("rb") as stream:
        names = [type(record).__name__ for record in StreamReader(stream).records]
    assert names[:5] == ["Header", *["Attachment"] * (len(ATTACHMENTS) + 1), "Metadata"]
    with (tmp_path / "trial.mcap").open("rb") as stream:
        reader = make_reader(stream)
        assert {a.name for a in reader.iter_attachments()} == {*ATTACHMENTS, topics.PLAN_ATTACHMENT}
        assert [m.metadata for m in reader.iter_metadata()] == [METADATA]


def test_shapes_are_placed_by_a_transform_of_the_same_or_an_earlier_time(tmp_path: Path) -> None:
    write_log(tmp_path / "trial.mcap", ticks=20)
    first: dict[str, tuple[int, int]] = {}
    frames: dict[str, set[str]] = {}
    with (tmp_path / "trial.mcap").open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        wanted = (topics.TRANSFORMS, *MODEL_TOPICS)
        for place, (_, channel, message, decoded) in enumerate(reader.iter_decoded_messages(wanted)):
            first.setdefault(channel.topic, (message.log_time, place))
            if channel.topic == topics.TRANSFORMS:
                frames[channel.topic] = {transform.child_frame_id for transform in decoded.transforms}
            else:
                frames[channel.topic] = {entity.frame_id for entity in decoded.entities}
    assert all(first[topics.TRANSFORMS] < first[topic] for topic in MODEL_TOPICS)
    assert frames[topics.TRANSFORMS] == {*BODIES, topics.PLAN_FRAME}
    assert frames[topics.MODEL] | frames[topics.PLAN] <= frames[topics.TRANSFORMS]
    assert frames[topics.TERRAIN] == {topics.WORLD_FRAME}


def test_time_stamps_are_simulated_time(tmp_path: Path) -> None:
    with write_log(tmp_path / "trial.mcap", ticks=20).open("rb") as stream:
        messages = [message for _, _, message in make_reader(stream).iter_messages(topics.STATE)]
    assert [message.log_time for message in messages] == [2_500_000 * index for index in range(20)]
    assert all(message.publish_time == message.log_time for message in messages)


def test_levels_are_one_scalar_each(tmp_path: Path) -> None:
    with write_log(tmp_path / "trial.mcap", ticks=1).open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    (schema,) = (schema for schema in summary.schemas.values() if schema.name == "quadlab.Levels")
    (message,) = FileDescriptorSet.FromString(schema.data).file[0].message_type
    assert tuple(field.name for field in message.field) == LEVELS
    assert all(field.label == field.LABEL_OPTIONAL for field in message.field)


def test_levels_must_be_announced_and_differ(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="unknown level 'forces'; announced: friction, swing, torque, torso"):
        recorder(tmp_path / "a.mcap", log_config(), LEVELS[:-1]).record(tick_record(0), body_poses(0))
    with pytest.raises(LogError, match="different column names"):
        recorder(tmp_path / "b.mcap", log_config(), ("com x", "com-x"))


def test_only_drawn_ticks_need_the_poses_of_the_bodies(tmp_path: Path) -> None:
    with recorder(tmp_path / "trial.mcap", log_config()) as log:
        assert log.draws(0.0)
        log.record(tick_record(0), body_poses(0))
        assert not log.draws(0.0025)
        log.record(tick_record(1), None)
        assert log.draws(0.02)
        with pytest.raises(LogError, match=r"at 0.02 s is drawn and needs the poses"):
            log.record(tick_record(8), None)


def test_events_carry_their_level_and_the_push_is_announced(tmp_path: Path) -> None:
    path = tmp_path / "trial.mcap"
    with recorder(path, log_config()) as log:
        for index in range(25):
            log.record(tick_record(index), body_poses(index))
        log.event(0.07, "fell: tilt 0.8 rad", EventLevel.ERROR)
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        found = [
            (message.log_time, decoded.level, decoded.message)
            for _, _, message, decoded in reader.iter_decoded_messages(topics.EVENTS)
        ]
    assert found == [
        (17_500_000, 2, "LF late touch-down 7"),
        (25_000_000, 2, "push of 150.0 N starts"),
        (50_000_000, 2, "push ends"),
        (70_000_000, 4, "fell: tilt 0.8 rad"),
    ]


def test_a_trial_that_ended_before_its_first_tick_is_a_log_too(tmp_path: Path) -> None:
    with write_log(tmp_path / "trial.mcap", ticks=0).open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert {topics.STATE, topics.CONTROL} <= {channel.topic for channel in summary.channels.values()}


def test_missing_residual_is_nan(tmp_path: Path) -> None:
    path = tmp_path / "trial.mcap"
    with recorder(path, log_config(), (*LEVELS, "unused")) as log:
        log.record(tick_record(0), body_poses(0))
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        (levels,) = [decoded for *_, decoded in reader.iter_decoded_messages(topics.LEVELS)]
    assert np.isnan(levels.unused)
    assert levels.torque == np.float32(tick_record(0).telemetry.level_residuals["torque"])
