"""Messages of named scalars to a table."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from google.protobuf.descriptor_pb2 import DescriptorProto, FileDescriptorSet
from mcap.records import Schema
from mcap_protobuf.decoder import DecoderFactory
from numpy.typing import NDArray

from quadlab.errors import LogError
from quadlab.trials.recording.log_file import NANOSECONDS, PROTOBUF
from quadlab.trials.recording.packed_message import packed_type_of

TIME_INDEX = "time_s"


def scalar_table(schema: Schema, times_ns: Sequence[int], messages: Sequence[bytes]) -> pd.DataFrame:
    """Return one row for each message, indexed by time in [s], and one column for each field of the schema.

    Messages that have the fixed layout of ``PackedMessageType`` are read in one step, others one by one by their
    descriptor; the values are the same.

    Args:
        schema: of the messages, which must be flat.
        times_ns: simulated times in [ns].
        messages: serialised.
    """
    description = _description_of(schema)
    packed = packed_type_of(description)
    rows = packed.decode(messages) if packed is not None else None
    if rows is None:
        columns = _decode_one_by_one(schema, description, messages)
    else:
        columns = {name: rows[name] for name in rows.dtype.names or ()}
    return pd.DataFrame(columns, index=time_index(times_ns))


def time_index(times_ns: Sequence[int]) -> "pd.Index[float]":
    """Return ``times_ns`` in [ns] as an index in [s]."""
    return pd.Index(np.array(times_ns, np.int64) / NANOSECONDS, name=TIME_INDEX, dtype=float)


def _description_of(schema: Schema) -> DescriptorProto:
    if schema.encoding == PROTOBUF:
        for file in FileDescriptorSet.FromString(schema.data).file:
            for message in file.message_type:
                if f"{file.package}.{message.name}" == schema.name:
                    return message
    raise LogError(f"schema '{schema.name}': not a protobuf message of its own description")


def _decode_one_by_one(
    schema: Schema, description: DescriptorProto, messages: Sequence[bytes]
) -> dict[str, NDArray[Any]]:
    decode = DecoderFactory().decoder_for(PROTOBUF, schema)
    if decode is None:
        raise LogError(f"schema '{schema.name}': cannot be decoded")
    decoded = [decode(message) for message in messages]
    return {field.name: np.array([getattr(row, field.name) for row in decoded]) for field in description.field}
