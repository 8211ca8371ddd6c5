"""Flat protobuf messages of fixed-width scalars, whose wire bytes have one layout for all messages.

A proto3 message is a sequence of (tag, value); where every value has a fixed width and every field is written, the
offsets of the values never change. Writing a message is then a copy of numbers into a buffer, and reading all
messages of a log is one ``numpy.frombuffer``. Any protobuf library decodes the same bytes by their descriptor.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
from google.protobuf.descriptor_pb2 import DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet
from numpy.typing import NDArray

PACKAGE = "quadlab"
FIRST_FIELD_NUMBER = 16
"""Tags of field numbers 16 to 2047 take two bytes: one stride for all fields of a type."""

_TAG_BYTES = 2
_WIRE_64_BIT, _WIRE_32_BIT = 1, 5


class FieldType(Enum):
    """A fixed-width scalar of protobuf, as (numpy dtype, descriptor type, wire type)."""

    DOUBLE = ("<f8", FieldDescriptorProto.TYPE_DOUBLE, _WIRE_64_BIT)
    FLOAT = ("<f4", FieldDescriptorProto.TYPE_FLOAT, _WIRE_32_BIT)
    FIXED32 = ("<u4", FieldDescriptorProto.TYPE_FIXED32, _WIRE_32_BIT)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Numpy type of the value, little endian."""
        return np.dtype(self.value[0])


@dataclass(frozen=True)
class PackedField:
    """One scalar of a message."""

    name: str
    number: int
    type: FieldType


@dataclass(frozen=True)
class PackedMessageType:
    """A protobuf message type of fixed-width scalars.

    Attributes:
        name: name of the message within the package ``quadlab``, e.g. "State".
        fields: in order of their numbers, each number in [16, 2047].
    """

    name: str
    fields: tuple[PackedField, ...]

    @property
    def full_name(self) -> str:
        """Name with package, e.g. "quadlab.State"."""
        return f"{PACKAGE}.{self.name}"

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """Structured numpy type of one message: a field for each value, holes for the tags."""
        return np.dtype(
            {
                "names": [field.name for field in self.fields],
                "formats": [field.type.dtype for field in self.fields],
                "offsets": self._offsets.tolist(),
                "itemsize": int(sum(_TAG_BYTES + field.type.dtype.itemsize for field in self.fields)),
            }
        )

    @cached_property
    def template(self) -> bytes:
        """Wire bytes of a message whose values are all zero."""
        return b"".join(_tag(field) + bytes(field.type.dtype.itemsize) for field in self.fields)

    @property
    def descriptor_set(self) -> bytes:
        """Serialised FileDescriptorSet, the schema data of an MCAP channel."""
        file = FileDescriptorProto(name=f"{PACKAGE}/{self.name}.proto", package=PACKAGE, syntax="proto3")
        message = file.message_type.add(name=self.name)
        for field in self.fields:
            message.field.add(
                name=field.name,
                number=field.number,
                type=field.type.value[1],
                label=FieldDescriptorProto.LABEL_OPTIONAL,
            )
        return FileDescriptorSet(file=[file]).SerializeToString(deterministic=True)

    def decode(self, messages: Sequence[bytes]) -> NDArray[Any] | None:
        """Return the messages as a structured array, (n,), or None if they do not have the layout.

        Other writers may leave out zeros or order fields differently; such messages need a protobuf library.
        """
        size = self.dtype.itemsize
        if any(len(message) != size for message in messages):
            return None
        joined = b"".join(messages)
        raw = np.frombuffer(joined, np.uint8).reshape(len(messages), size)
        tags = (self._offsets[:, None] + np.arange(-_TAG_BYTES, 0)).ravel()
        expected = np.frombuffer(self.template, np.uint8)[tags]
        return np.frombuffer(joined, self.dtype) if bool((raw[:, tags] == expected).all()) else None

    @cached_property
    def _offsets(self) -> NDArray[np.int64]:
        widths = [_TAG_BYTES + field.type.dtype.itemsize for field in self.fields]
        return np.array(np.cumsum([0, *widths[:-1]]) + _TAG_BYTES, np.int64)


def packed_type(name: str, columns: Iterable[tuple[str, FieldType]]) -> PackedMessageType:
    """Return the message type ``name`` with one field for each (column, type), numbered from 16."""
    fields = (PackedField(column, FIRST_FIELD_NUMBER + i, kind) for i, (column, kind) in enumerate(columns))
    return PackedMessageType(name, tuple(fields))


def packed_type_of(message: DescriptorProto) -> PackedMessageType | None:
    """Return the packed type that ``message`` describes, or None if it is not one."""
    kinds = {kind.value[1]: kind for kind in FieldType}
    ordered = sorted(message.field, key=lambda field: field.number)
    flat = all(f.type in kinds and f.label == FieldDescriptorProto.LABEL_OPTIONAL for f in ordered)
    if not flat or not ordered or ordered[0].number < FIRST_FIELD_NUMBER or ordered[-1].number > 2047:
        return None
    return PackedMessageType(message.name, tuple(PackedField(f.name, f.number, kinds[f.type]) for f in ordered))


def _tag(field: PackedField) -> bytes:
    key = field.number << 3 | field.type.value[2]
    return bytes((key & 0x7F | 0x80, key >> 7))
