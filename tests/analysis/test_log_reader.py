"""What was recorded comes back, and what is no log says so."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_protobuf.decoder import DecoderFactory
from scipy.spatial.transform import Rotation
from synthetic_records import (
    ATTACHMENTS,
    CONTROL_PERIOD,
    LEVELS,
    METADATA,
    log_config,
    motion_plan,
    tick_record,
    write_interrupted_log,
    write_log,
)

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.scalar_table import scalar_table
from quadlab.analysis.trial_log import TrialLog, leg_vectors, vectors
from quadlab.errors import LogError
from quadlab.robots.legs import LEGS
from quadlab.trials.recording import topics

TICKS = 60


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_log(tmp_path_factory.mktemp("log") / "trial.mcap", ticks=TICKS)


@pytest.fixture(scope="module")
def log(path: Path) -> TrialLog:
    return read_log(path)


def test_state_comes_back_exactly(log: TrialLog) -> None:
    for index in range(TICKS):
        tick = tick_record(index)
        row = log.state.iloc[[index]]
        assert row["time_s"].item() == tick.state.time_s
        np.testing.assert_array_equal(vectors(row, "base_position")[0], tick.state.position_base_in_world)
        np.testing.assert_array_equal(vectors(row, "base_quat")[0], tick.state.quat_wxyz)
        np.testing.assert_array_equal(vectors(row, "joint_position")[0], tick.state.joint_positions)
        np.testing.assert_array_equal(vectors(row, "joint_torque")[0], tick.command.torques)
        np.testing.assert_array_equal(leg_vectors(row, "foot_force")[0], tick.state.foot_forces_in_world)
        expected_push = tick.pushes[0][1] if tick.pushes else np.zeros(3)
        np.testing.assert_array_equal(vectors(row, "push_force")[0], expected_push)


def test_control_comes_back_in_single_precision(log: TrialLog) -> None:
    for index in range(TICKS):
        telemetry = tick_record(index).telemetry
        row = log.control.iloc[[index]]
        single = np.float32
        np.testing.assert_array_equal(vectors(row, "com")[0], telemetry.com_position.astype(single))
        error = telemetry.com_position - telemetry.com_position_reference
        np.testing.assert_array_equal(vectors(row, "com_error")[0], error.astype(single))
        attitude = Rotation.from_quat(tick_record(index).state.quat_wxyz, scalar_first=True).as_euler("xyz")
        np.testing.assert_allclose(vectors(row, "base")[0], attitude, atol=1e-6)
        np.testing.assert_array_equal(vectors(row, "plan_pose")[0], telemetry.plan_pose_in_world.astype(single))
        references = telemetry.foot_position_references.astype(single)
        np.testing.assert_array_equal(leg_vectors(row, "foot_position_reference")[0], references)
        np.testing.assert_array_equal(vectors(row, "torque_desired")[0], telemetry.torques_desired.astype(single))
        np.testing.assert_array_equal(vectors(row, "leg_mode")[0], telemetry.leg_modes)
        np.testing.assert_array_equal(vectors(row, "planned_contact")[0], telemetry.planned_contacts)
        assert row["solver_iterations"].item() == index
        residuals = log.levels.iloc[index]
        assert residuals.to_dict() == {k: single(v) for k, v in telemetry.level_residuals.items()}


def test_tables_share_one_index_of_simulated_time(log: TrialLog) -> None:
    np.testing.assert_allclose(log.state.index, np.arange(TICKS) * CONTROL_PERIOD, atol=1e-12)
    for table in (log.control, log.levels, log.timing):
        pd.testing.assert_index_equal(table.index, log.state.index)
    assert log.events.index.name == log.state.index.name == "time_s"
    assert tuple(log.levels.columns) == LEVELS


def test_fast_reader_agrees_with_the_protobuf_reader(path: Path, log: TrialLog) -> None:
    tables = {topics.STATE: log.state, topics.CONTROL: log.control, topics.LEVELS: log.levels}
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for topic, table in tables.items():
            messages = [decoded for *_, decoded in reader.iter_decoded_messages(topic)]
            slow = pd.DataFrame({c: [getattr(m, c) for m in messages] for c in table.columns}, index=table.index)
            pd.testing.assert_frame_equal(slow.astype(table.dtypes.to_dict()), table)


def test_messages_of_another_protobuf_writer_are_read_by_their_descriptor(path: Path, log: TrialLog) -> None:
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        rows = [
            (schema, message.log_time, decoded)
            for schema, _, message, decoded in reader.iter_decoded_messages("/state")
        ]
    short = [decoded.SerializeToString() for *_, decoded in rows]
    assert any(len(data) < len(short[10]) for data in short), "the library leaves out zeros"
    schema = rows[0][0]
    assert schema is not None
    table = scalar_table(schema, [time for _, time, _ in rows], short)
    pd.testing.assert_frame_equal(table, log.state)


def test_plan_attachments_and_metadata_come_back(log: TrialLog) -> None:
    assert log.attachments["config.yaml"] == ATTACHMENTS["config.yaml"][1]
    assert log.metadata == METADATA
    plan = motion_plan()
    for time_s in np.linspace(*plan.com.span, 7):
        np.testing.assert_array_equal(log.plan.com(time_s), plan.com(time_s))
    np.testing.assert_array_equal(log.plan.schedule.contacts, plan.schedule.contacts)
    for mine, theirs in zip(log.plan.footholds, plan.footholds, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    assert log.plan.verdict == plan.verdict


def test_events_are_listed_in_order_of_time(log: TrialLog) -> None:
    assert log.events["message"].tolist() == [
        "LF late touch-down 7",
        "push of 150.0 N starts",
        "push ends",
        "LF late touch-down 57",
    ]
    assert set(log.events["level"]) == {"INFO"}
    assert log.events.index.is_monotonic_increasing


def test_vectors_are_not_confused_by_longer_names(log: TrialLog) -> None:
    assert vectors(log.control, "com").shape == (TICKS, 3)
    assert vectors(log.control, "cop_reference").shape == (TICKS, 2)
    assert vectors(log.control, "foot_position_LF").shape == (TICKS, 3)
    assert vectors(log.control, "base").shape == (TICKS, 3)
    assert leg_vectors(log.control, "foot_position").shape == (TICKS, len(LEGS), 3)
    with pytest.raises(LogError, match="no vector 'comm'"):
        vectors(log.control, "comm")


def test_log_without_computing_times_or_ticks(tmp_path: Path) -> None:
    quiet = read_log(write_log(tmp_path / "quiet.mcap", ticks=3, config=log_config(wall_times=False)))
    assert quiet.timing.shape == (3, 0)
    assert quiet.plan.report.solve_ms == 0.0
    empty = read_log(write_log(tmp_path / "empty.mcap", ticks=0))
    assert len(empty.state) == len(empty.control) == len(empty.events) == 0
    assert "com_x" in empty.control


def test_a_cut_log_says_how_to_recover_it(tmp_path: Path, path: Path) -> None:
    cut = tmp_path / "trial.mcap"
    content = path.read_bytes()
    for length in (9, 1000, len(content) // 2, len(content) - 1):
        cut.write_bytes(content[:length])
        with pytest.raises(LogError, match=f"quadlab recover {cut}"):
            read_log(cut)
    part = write_interrupted_log(tmp_path / "b.mcap", ticks=1)
    with pytest.raises(LogError, match=f"quadlab recover {part}"):
        read_log(part)


def test_a_damaged_log_says_so(tmp_path: Path, path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0xFF
    (tmp_path / "trial.mcap").write_bytes(content)
    with pytest.raises(LogError, match="damaged"):
        read_log(tmp_path / "trial.mcap")


@pytest.mark.parametrize("content", [b"", b"short", b"some text that is no log at all"])
def test_foreign_and_missing_files_are_clear_errors(tmp_path: Path, content: bytes) -> None:
    foreign = tmp_path / "notes.txt"
    with pytest.raises(LogError, match="not found"):
        read_log(foreign)
    foreign.write_bytes(content)
    with pytest.raises(LogError, match="not an MCAP file"):
        read_log(foreign)


def test_an_mcap_file_of_somebody_else_is_not_a_trial_log(tmp_path: Path) -> None:
    other = tmp_path / "other.mcap"
    writer = Writer(str(other))
    writer.start(profile="ros2")
    writer.finish()
    with pytest.raises(LogError, match="not a trial log"):
        read_log(other)
