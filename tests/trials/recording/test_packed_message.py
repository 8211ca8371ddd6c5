"""The wire bytes of named scalars are ordinary protobuf."""

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import DescriptorProto, FileDescriptorSet
from mcap.records import Schema
from mcap_protobuf.decoder import DecoderFactory
from synthetic_records import LEVELS, tick_record

from quadlab.trials.recording.columns import (
    CONTROL_BLOCKS,
    STATE_BLOCKS,
    TIMING_BLOCKS,
    Block,
    level_blocks,
    level_column,
)
from quadlab.trials.recording.packed_message import FieldType, packed_type, packed_type_of
from quadlab.trials.recording.tick_packer import TickPacker

TOPICS = [
    pytest.param(STATE_BLOCKS, id="state"),
    pytest.param(CONTROL_BLOCKS, id="control"),
    pytest.param(TIMING_BLOCKS, id="timing"),
    pytest.param(level_blocks(LEVELS), id="levels"),
]


@pytest.mark.parametrize("blocks", TOPICS)
def test_protobuf_library_reads_the_recorded_values_from_the_wire_bytes(blocks: tuple[Block, ...]) -> None:
    packer, tick = TickPacker("Message", blocks), tick_record(12)
    schema = Schema(id=1, name=packer.type.full_name, encoding="protobuf", data=packer.type.descriptor_set)
    decode = DecoderFactory().decoder_for("protobuf", schema)
    assert decode is not None
    message = decode(packer.pack(tick))
    for block in blocks:
        expected = np.broadcast_to(np.asarray(block.value(tick), block.type.dtype), len(block.columns))
        np.testing.assert_array_equal([getattr(message, column) for column in block.columns], expected)


@pytest.mark.parametrize("blocks", TOPICS)
def test_columns_have_unique_names(blocks: tuple[Block, ...]) -> None:
    columns = [column for block in blocks for column in block.columns]
    assert len(set(columns)) == len(columns)


def test_packing_a_tick_leaves_nothing_of_the_tick_before() -> None:
    packer = TickPacker("Message", STATE_BLOCKS)
    fresh = TickPacker("Message", STATE_BLOCKS)
    packer.pack(tick_record(12))
    assert packer.pack(tick_record(30)) == fresh.pack(tick_record(30))


def test_descriptor_tells_the_layout() -> None:
    packed = TickPacker("Control", CONTROL_BLOCKS).type
    description = FileDescriptorSet.FromString(packed.descriptor_set).file[0].message_type[0]
    assert packed_type_of(description) == packed


def test_messages_of_mixed_widths_keep_their_values() -> None:
    packed = packed_type("Mixed", [("a", FieldType.DOUBLE), ("b", FieldType.FIXED32), ("c", FieldType.FLOAT)])
    blank = packed.decode([packed.template] * 3)
    assert blank is not None
    assert blank.tolist() == [(0.0, 0, 0.0)] * 3


def test_a_message_of_another_layout_is_not_decoded_as_this_one() -> None:
    packed = packed_type("A", [("a", FieldType.FLOAT), ("b", FieldType.FLOAT)])
    swapped = packed.template[6:] + packed.template[:6]
    assert packed.decode([packed.template, swapped]) is None
    assert packed.decode([packed.template, b""]) is None


def test_a_descriptor_with_a_text_field_is_no_packed_type() -> None:
    message = DescriptorProto(name="Text")
    message.field.add(name="a", number=16, type=9, label=1)
    assert packed_type_of(message) is None


@pytest.mark.parametrize(
    ("level", "column"),
    [("torque", "torque"), ("CoM x, y", "CoM_x_y"), ("2nd level", "level_2nd_level"), ("", "level_")],
)
def test_level_names_become_field_names(level: str, column: str) -> None:
    assert level_column(level) == column
