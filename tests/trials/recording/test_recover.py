"""A log that was cut short loses at most the chunk under way."""

from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from synthetic_records import ATTACHMENTS, write_interrupted_log, write_log

from quadlab.errors import LogError
from quadlab.trials.recording import topics
from quadlab.trials.recording.recover import COMPLETE, default_target, recover_log

Found = list[tuple[str, int, bytes]]


def _messages(path: Path) -> Found:
    with path.open("rb") as stream:
        rows = make_reader(stream, validate_crcs=True).iter_messages(log_time_order=False)
        return [(channel.topic, message.log_time, message.data) for _, channel, message in rows]


def _chunk_ends(path: Path) -> list[tuple[int, int]]:
    """Return for each chunk (end of the chunk in the file, number of messages in it)."""
    with path.open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        assert summary is not None
        chunks = sorted(summary.chunk_indexes, key=lambda chunk: chunk.chunk_start_offset)
    counts = []
    raw = path.read_bytes()
    for chunk in chunks:
        records = sum(
            int.from_bytes(raw[offset + 11 : offset + 15], "little") // 16
            for offset in chunk.message_index_offsets.values()
        )
        counts.append((chunk.chunk_start_offset + chunk.chunk_length, records))
    return counts


@pytest.mark.parametrize("seed", range(8))
def test_every_whole_chunk_of_a_cut_file_is_recovered(tmp_path: Path, seed: int) -> None:
    whole = write_log(tmp_path / "whole.mcap", ticks=100)
    content = whole.read_bytes()
    chunks = _chunk_ends(whole)
    assert len(chunks) > 5
    cut = int(np.random.default_rng(seed).integers(chunks[0][0], chunks[-1][0]))
    part = tmp_path / "trial.mcap.part"
    part.write_bytes(content[:cut])
    report = recover_log(part, default_target(part))
    kept = sum(count for end, count in chunks if end <= cut)
    assert report.messages == kept
    assert _messages(tmp_path / "trial.recovered.mcap") == _messages(whole)[:kept]
    assert report.last_time_s == pytest.approx(max(time for _, time, _ in _messages(whole)[:kept]) / 1e9)
    assert report.reason != COMPLETE
    assert part.read_bytes() == content[:cut]


def test_a_cut_before_the_first_chunk_saves_no_message_and_is_an_error_only_within_the_header(tmp_path: Path) -> None:
    whole = write_log(tmp_path / "whole.mcap", ticks=10)
    content, first_chunk = whole.read_bytes(), _chunk_ends(whole)[0][0]
    header_end = 8 + 9 + int.from_bytes(content[9:17], "little")  # magic, opcode and length, content
    for number, cut in enumerate(range(0, first_chunk, 97)):
        part, target = tmp_path / f"{number}.part", tmp_path / f"{number}.mcap"
        part.write_bytes(content[:cut])
        if cut < header_end:
            with pytest.raises(LogError, match="nothing to recover"):
                recover_log(part, target)
            assert not target.exists()
        else:
            assert recover_log(part, target).messages == 0


def test_a_trial_that_raised_loses_no_tick(tmp_path: Path) -> None:
    path = tmp_path / "trial.mcap"
    report = recover_log(write_interrupted_log(path, ticks=33), path)
    assert report.last_time_s == pytest.approx(32 * 0.0025)
    assert sum(topic == topics.STATE for topic, _, _ in _messages(path)) == 33
    with path.open("rb") as stream:
        attached = {attachment.name: attachment.data for attachment in make_reader(stream).iter_attachments()}
    assert attached["config.yaml"] == ATTACHMENTS["config.yaml"][1]


def test_a_complete_log_is_copied_whole(tmp_path: Path) -> None:
    whole = write_log(tmp_path / "whole.mcap", ticks=50)
    report = recover_log(whole, tmp_path / "copy.mcap")
    assert report.reason == COMPLETE
    assert _messages(tmp_path / "copy.mcap") == _messages(whole)


def test_a_damaged_chunk_ends_the_recovery(tmp_path: Path) -> None:
    whole = write_log(tmp_path / "whole.mcap", ticks=100)
    content, chunks = bytearray(whole.read_bytes()), _chunk_ends(whole)
    content[chunks[2][0] - 50] ^= 0xFF
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(content)
    report = recover_log(damaged, tmp_path / "saved.mcap")
    assert report.messages == chunks[0][1] + chunks[1][1]
    assert report.reason != COMPLETE


def test_an_existing_file_is_never_overwritten(tmp_path: Path) -> None:
    whole = write_log(tmp_path / "whole.mcap", ticks=5)
    target = tmp_path / "precious.mcap"
    target.write_text("precious")
    with pytest.raises(LogError, match="exists already"):
        recover_log(whole, target)
    assert target.read_text() == "precious"


def test_missing_and_foreign_files_are_clear_errors(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="not found"):
        recover_log(tmp_path / "none.mcap.part", tmp_path / "out.mcap")
    (tmp_path / "text.mcap").write_text("this is no log at all, only a few words")
    with pytest.raises(LogError, match="not an MCAP file"):
        recover_log(tmp_path / "text.mcap", tmp_path / "out.mcap")


@pytest.mark.parametrize(
    ("part", "target"),
    [("trial.mcap.part", "trial.recovered.mcap"), ("x.mcap", "x.recovered.mcap"), ("y.part", "y.recovered")],
)
def test_default_target_is_another_file_beside_the_part(part: str, target: str) -> None:
    assert default_target(Path(part)) == Path(target)
