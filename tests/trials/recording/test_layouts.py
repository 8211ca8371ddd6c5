"""The layouts for Foxglove and PlotJuggler show only what is logged."""

import json
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

import quadlab.trials.recording
from quadlab.paths import CONF_DIR
from quadlab.trials.recording import topics
from quadlab.trials.recording.columns import CONTROL_BLOCKS, STATE_BLOCKS, Block, level_blocks
from quadlab.trials.recording.scene_writer import SCENE_TOPICS

LAYOUTS = Path(quadlab.trials.recording.__file__).parent / "layouts"
FOXGLOVE = json.loads((LAYOUTS / "foxglove.json").read_text())
PLOTJUGGLER = ET.parse(LAYOUTS / "plotjuggler.xml").getroot()
DRAWINGS = {topic for topic, kind in SCENE_TOPICS.items() if kind is SceneUpdate}


def _default_levels() -> list[str]:
    levels = yaml.safe_load((CONF_DIR / "controller" / "hierarchical.yaml").read_text())["levels"]
    return [level["name"] for level in levels]


def _columns(blocks: tuple[Block, ...]) -> set[str]:
    return {column for block in blocks for column in block.columns}


COLUMNS = {
    topics.STATE: _columns(STATE_BLOCKS),
    topics.CONTROL: _columns(CONTROL_BLOCKS),
    topics.LEVELS: _columns(level_blocks(_default_levels())),
}
FOXGLOVE_PATHS = [
    path["value"] for panel in FOXGLOVE["configById"].values() for path in panel.get("paths", [])
]  # "/topic.field"
CURVES = [curve.attrib["name"] for curve in PLOTJUGGLER.iter("curve")]  # "/topic/field"


def _panels(node: Any) -> Iterator[str]:
    if isinstance(node, str):
        yield node
    else:
        yield from _panels(node["first"])
        yield from _panels(node["second"])


@pytest.mark.parametrize("path", FOXGLOVE_PATHS)
def test_foxglove_plots_only_what_is_logged(path: str) -> None:
    topic, field = path.split(".")
    assert field in COLUMNS[topic]


@pytest.mark.parametrize("curve", CURVES)
def test_plotjuggler_plots_only_what_is_logged(curve: str) -> None:
    topic, field = curve.rsplit("/", 1)
    assert field in COLUMNS[topic]


def test_both_layouts_show_the_residual_of_every_level_of_the_default_controller() -> None:
    levels = {f"{topics.LEVELS}.{column}" for column in COLUMNS[topics.LEVELS]}
    assert levels <= set(FOXGLOVE_PATHS)
    assert {level.replace(".", "/") for level in levels} <= set(CURVES)


def test_foxglove_draws_every_scene_and_lists_the_events() -> None:
    (scene,) = (panel for name, panel in FOXGLOVE["configById"].items() if name.startswith("3D!"))
    assert {topic for topic, shown in scene["topics"].items() if shown["visible"]} == DRAWINGS
    assert scene["fixedFrame"] == topics.WORLD_FRAME
    (log,) = (panel for name, panel in FOXGLOVE["configById"].items() if name.startswith("RosOut!"))
    assert log["topicToRender"] == topics.EVENTS


def test_every_configured_foxglove_panel_has_a_place() -> None:
    configured = set(FOXGLOVE["configById"])
    placed = set(_panels(FOXGLOVE["layout"]))
    for tab in FOXGLOVE["configById"]["Tab!plots"]["tabs"]:
        placed |= set(_panels(tab["layout"]))
    assert placed == configured
