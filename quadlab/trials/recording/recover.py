"""Making a proper log of one that was cut short by a crash."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.records import Attachment, Channel, DataEnd, Header, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from zstandard import ZstdError

from quadlab.errors import LogError
from quadlab.trials.files import unfinished_path
from quadlab.trials.recording.log_file import NANOSECONDS, LogFile
from quadlab.trials.recording.topics import PART_SUFFIX

COMPLETE = "complete"
_CHUNK_SIZE = 64 * 1024  # [B]
_DAMAGED = (McapError, CRCValidationError, ZstdError, UnicodeDecodeError, struct.error)


@dataclass(frozen=True)
class RecoveryReport:
    """What could be saved.

    Attributes:
        messages: number of messages copied.
        last_time_s: simulated time of the last of them in [s]; None without messages.
        reason: "complete", or why reading ended.
    """

    messages: int
    last_time_s: float | None
    reason: str


def recover_log(part: Path, target: Path) -> RecoveryReport:
    """Copy every whole record of ``part`` into the indexed log ``target``; ``part`` stays as it is.

    Raises:
        LogError: if ``part`` is missing or no MCAP file, or if ``target`` exists already.
    """
    if not part.is_file():
        raise LogError(f"{part}: not found; expected a log that was cut short, usually *.mcap{PART_SUFFIX}")
    if target.exists():
        raise LogError(f"{target}: exists already; remove or rename it first")
    with part.open("rb") as stream:
        records = StreamReader(_WholeReads(stream), validate_crcs=True, record_size_limit=part.stat().st_size).records
        profile = _profile_of(records, part)
        file = LogFile(target, unfinished_path(target, ".recovering"), _CHUNK_SIZE, profile)
        report = _copy(records, file)
    file.finish()
    return report


def default_target(part: Path) -> Path:
    """Return where a recovered log goes: ``x.mcap.part`` and ``x.mcap`` both to ``x.recovered.mcap``.

    A name that no trial writes, so that ``quadlab clean`` never takes it for what a trial left.
    """
    log = part.with_suffix("") if part.suffix == PART_SUFFIX else part
    return log.with_suffix(f".recovered{log.suffix}")


class _WholeReads:
    """A stream whose short reads are errors, so that a cut record is never taken for a whole one."""

    def __init__(self, stream: BufferedReader) -> None:
        self._stream = stream

    def read(self, length: int) -> bytes:
        data = self._stream.read(length)
        if len(data) < length:
            raise EndOfFile("the file ends in the middle of a record")
        return data


class _Copier:
    """Adds records to a log under ids of its own."""

    def __init__(self, file: LogFile) -> None:
        self._writer = file.writer
        self._schemas: dict[int, int] = {0: 0}
        self._channels: dict[int, int] = {}
        self.messages = 0
        self.last_ns: int | None = None

    def add(self, record: McapRecord) -> None:
        match record:
            case Message():
                self._add_message(record)
            case Schema() if record.id not in self._schemas:
                self._schemas[record.id] = self._writer.register_schema(record.name, record.encoding, record.data)
            case Channel() if record.id not in self._channels:
                schema = self._schemas[record.schema_id]
                channel = self._writer.register_channel(record.topic, record.message_encoding, schema, record.metadata)
                self._channels[record.id] = channel
            case Attachment():
                name, media_type, data = record.name, record.media_type, record.data
                self._writer.add_attachment(record.create_time, record.log_time, name, media_type, data)
            case Metadata():
                self._writer.add_metadata(record.name, record.metadata)

    def _add_message(self, message: Message) -> None:
        channel = self._channels[message.channel_id]
        self._writer.add_message(channel, message.log_time, message.data, message.publish_time, message.sequence)
        self.messages += 1
        self.last_ns = max(message.log_time, self.last_ns or 0)


def _profile_of(records: Iterator[McapRecord], part: Path) -> str:
    try:
        header = next(records)
    except (InvalidMagic, EndOfFile, struct.error) as error:
        raise LogError(f"{part}: not an MCAP file, or cut within its first record; nothing to recover") from error
    return header.profile if isinstance(header, Header) else ""


def _copy(records: Iterator[McapRecord], file: LogFile) -> RecoveryReport:
    copier, reason = _Copier(file), COMPLETE
    try:
        for record in records:
            if isinstance(record, DataEnd):
                break
            copier.add(record)
    except _DAMAGED as error:
        reason = str(error) or type(error).__name__
    last_s = None if copier.last_ns is None else copier.last_ns / NANOSECONDS
    return RecoveryReport(copier.messages, last_s, reason)
