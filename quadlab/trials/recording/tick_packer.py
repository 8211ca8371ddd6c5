"""Ticks to wire bytes of one topic of named scalars."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quadlab.trials.recording.columns import Block
from quadlab.trials.recording.packed_message import PackedMessageType, packed_type
from quadlab.trials.recording.record import TickRecord


class TickPacker:
    """Writes the blocks of a topic into one reused buffer.

    Attributes:
        type: the message type that the bytes have.
    """

    def __init__(self, type_name: str, blocks: Sequence[Block]) -> None:
        """Lay out the message ``type_name`` with the columns of ``blocks``, in their order."""
        self.type: PackedMessageType = packed_type(
            type_name, ((column, block.type) for block in blocks for column in block.columns)
        )
        self._buffer = bytearray(self.type.template)
        self._targets = [(self._view_of(block), block.value) for block in blocks]

    def pack(self, tick: TickRecord) -> bytes:
        """Return the message of ``tick``."""
        for view, value in self._targets:
            view[...] = value(tick)
        return bytes(self._buffer)

    def _view_of(self, block: Block) -> NDArray[Any]:
        offsets = self.type.dtype.fields
        if offsets is None:
            raise TypeError(f"{self.type.full_name} has no fields")
        first = offsets[block.columns[0]][1]
        stride = block.type.dtype.itemsize + 2
        return np.ndarray(len(block.columns), block.type.dtype, self._buffer, offset=first, strides=(stride,))
