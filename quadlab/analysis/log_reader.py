"""Reading a trial log in one call."""

import struct
from dataclasses import dataclass, field
from io import BufferedReader
from pathlib import Path

import pandas as pd
from foxglove_schemas_protobuf.Log_pb2 import Log
from mcap.exceptions import McapError
from mcap.reader import McapReader, make_reader
from mcap.records import Schema
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from quadlab.analysis.scalar_table import scalar_table, time_index
from quadlab.analysis.trial_log import TrialLog
from quadlab.errors import LogError
from quadlab.trials.recording import topics

_SCALAR_TOPICS = (topics.STATE, topics.ESTIMATE, topics.CONTROL, topics.LEVELS, topics.TIMING)
_REQUIRED = {topics.STATE, topics.CONTROL, topics.EVENTS}
_DAMAGED = (McapError, ZstdError, ValueError, KeyError, struct.error)


@dataclass
class _Messages:
    """The messages of a topic as they lie in the file."""

    schema: Schema
    times_ns: list[int] = field(default_factory=list)
    data: list[bytes] = field(default_factory=list)


def read_log(path: Path | str) -> TrialLog:
    """Return the content of a trial log.

    Raises:
        LogError: if the file is missing, was cut short, is damaged, or is not a trial log of quadlab.
    """
    path = Path(path)
    if not path.is_file():
        raise LogError(f"{path}: not found; a trial writes trial.mcap into its folder")
    with path.open("rb") as stream:
        _check_ends(stream, path)
        try:
            return _read(make_reader(stream, validate_crcs=True), path)
        except _DAMAGED as error:
            raise LogError(f"{path}: damaged ({error}); run 'quadlab recover {path}'") from error


def _check_ends(stream: BufferedReader, path: Path) -> None:
    magic = len(MCAP0_MAGIC)
    if stream.read(magic) != MCAP0_MAGIC:
        raise LogError(f"{path}: not an MCAP file; expected the log of a trial, trial.mcap")
    stream.seek(-magic, 2)
    if stream.tell() < magic or stream.read() != MCAP0_MAGIC:
        raise LogError(f"{path}: cut short, its trial did not end properly; run 'quadlab recover {path}'")
    stream.seek(0)


def _read(reader: McapReader, path: Path) -> TrialLog:
    found = _messages_by_topic(reader)
    if reader.get_header().profile != topics.PROFILE or not found.keys() >= _REQUIRED:
        needed = ", ".join(sorted(_REQUIRED))
        raise LogError(f"{path}: not a trial log of quadlab; one has profile '{topics.PROFILE}' and topics {needed}")
    tables = {
        topic: scalar_table(rows.schema, rows.times_ns, rows.data)
        for topic, rows in found.items()
        if topic in _SCALAR_TOPICS
    }
    none = pd.DataFrame(index=tables[topics.STATE].index)
    return TrialLog(
        state=tables[topics.STATE],
        estimate=tables.get(topics.ESTIMATE, none),
        control=tables[topics.CONTROL],
        levels=tables.get(topics.LEVELS, none),
        timing=tables.get(topics.TIMING, none),
        events=_event_table(found[topics.EVENTS]),
        attachments={attachment.name: attachment.data for attachment in reader.iter_attachments()},
        metadata=next((m.metadata for m in reader.iter_metadata() if m.name == topics.TRIAL_METADATA), {}),
    )


def _messages_by_topic(reader: McapReader) -> dict[str, _Messages]:
    summary = reader.get_summary()
    if summary is None:
        return {}
    wanted = {*_SCALAR_TOPICS, topics.EVENTS}
    channels = [channel for channel in summary.channels.values() if channel.topic in wanted and channel.schema_id]
    found = {channel.topic: _Messages(summary.schemas[channel.schema_id]) for channel in channels}
    for _, channel, message in reader.iter_messages(topics=list(found), log_time_order=False):
        found[channel.topic].times_ns.append(message.log_time)
        found[channel.topic].data.append(message.data)
    return found


def _event_table(rows: _Messages) -> pd.DataFrame:
    entries = [Log.FromString(data) for data in rows.data]
    levels = [Log.Level.Name(entry.level) for entry in entries]
    messages = [entry.message for entry in entries]
    return pd.DataFrame({"level": levels, "message": messages}, index=time_index(rows.times_ns), dtype=str)
