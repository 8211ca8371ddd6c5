"""An MCAP file that has its final name only when it is complete."""

import os
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer
from mcap_protobuf.schema import build_file_descriptor_set

from quadlab.trials.recording.topics import PROFILE

PROTOBUF = "protobuf"
NANOSECONDS = 1_000_000_000


def nanoseconds(time_s: float) -> int:
    """Return ``time_s`` in [ns], the time stamp of the log."""
    return round(time_s * NANOSECONDS)


class LogFile:
    """A log under construction; time stamps are simulated time in [ns], log and publish time the same."""

    def __init__(self, path: Path, unfinished: Path, chunk_size: int, profile: str = PROFILE) -> None:
        """Start writing.

        Args:
            path: name of the complete file.
            unfinished: name until then; both in one folder.
            chunk_size: bytes that are compressed and written together, and that a crash may cost.
            profile: profile of the header.
        """
        self._path, self._unfinished = path, unfinished
        unfinished.parent.mkdir(parents=True, exist_ok=True)
        self._stream = unfinished.open("wb")
        self._writer = Writer(self._stream, chunk_size=chunk_size, compression=CompressionType.ZSTD)
        self._writer.start(profile=profile)
        self._schemas: dict[str, int] = {}

    @property
    def writer(self) -> Writer:
        """The MCAP writer, for attachments, metadata and copied records."""
        return self._writer

    def add_channel(self, topic: str, type_name: str, descriptor_set: bytes) -> int:
        """Return the id of a new channel of protobuf messages."""
        if type_name not in self._schemas:
            self._schemas[type_name] = self._writer.register_schema(type_name, PROTOBUF, descriptor_set)
        channel: int = self._writer.register_channel(topic, PROTOBUF, self._schemas[type_name])
        return channel

    def add_foxglove_channel(self, topic: str, message_class: Any) -> int:
        """Return the id of a new channel of a generated protobuf class."""
        descriptor_set = build_file_descriptor_set(message_class).SerializeToString(deterministic=True)
        return self.add_channel(topic, message_class.DESCRIPTOR.full_name, descriptor_set)

    def write(self, channel: int, time_ns: int, data: bytes) -> None:
        """Append a serialised message."""
        self._writer.add_message(channel, time_ns, data, time_ns)

    def flush(self) -> None:
        """Hand what was compressed so far to the operating system."""
        self._stream.flush()

    def finish(self) -> None:
        """Write index and summary to the disk, and give the file its final name, which an older one loses."""
        self._writer.finish()
        self._stream.flush()
        os.fsync(self._stream.fileno())  # the result, which follows, says that the log is whole
        self._stream.close()
        os.replace(self._unfinished, self._path)

    def abandon(self) -> None:
        """Write out what there is and leave the file unfinished."""
        self._writer.flush()
        self._stream.close()
