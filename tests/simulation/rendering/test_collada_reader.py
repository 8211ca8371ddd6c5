"""The COLLADA reader on small documents with known geometry."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quadlab.errors import RobotDescriptionError
from quadlab.simulation.rendering.collada import read_collada
from quadlab.simulation.rendering.mesh_files import read_mesh
from quadlab.simulation.rendering.texture import colored_meshes

TRIANGLES = '<triangles count="2" material="m">{inputs}<p>{p}</p></triangles>'
SQUARE = "0 0 0  1 0 0  1 2 0  0 2 0"
PLAIN_INPUT = '<input semantic="VERTEX" source="#v" offset="0"/>'


def document(
    primitive: str,
    *,
    asset: str = '<unit meter="1"/><up_axis>Z_UP</up_axis>',
    transform: str = "",
    diffuse: str = "<color>0.2 0.4 0.6 1</color>",
    extra_source: str = "",
) -> str:
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset>{asset}</asset>
  <library_images><image id="img"><init_from>picture.png</init_from></image></library_images>
  <library_effects><effect id="e"><profile_COMMON>
    <newparam sid="surf"><surface type="2D"><init_from>img</init_from></surface></newparam>
    <newparam sid="samp"><sampler2D><source>surf</source></sampler2D></newparam>
    <technique sid="c"><lambert><diffuse>{diffuse}</diffuse></lambert></technique></profile_COMMON></effect>
  </library_effects>
  <library_materials><material id="mat"><instance_effect url="#e"/></material></library_materials>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="12">{SQUARE}</float_array>
      <technique_common><accessor source="#a" count="4" stride="3"/></technique_common></source>{extra_source}
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{primitive}</mesh></geometry>
  </library_geometries>
  <library_visual_scenes><visual_scene id="s"><node>{transform}<node>
    <instance_geometry url="#g"><bind_material><technique_common>
      <instance_material symbol="m" target="#mat"/></technique_common></bind_material></instance_geometry>
  </node></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>"""


def write(folder: Path, text: str) -> Path:
    path = folder / "mesh.dae"
    path.write_text(text)
    return path


def area(corners: np.ndarray) -> float:
    edges = corners[:, 1:] - corners[:, :1]
    return float(0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum())


PRIMITIVES = {
    "triangles": TRIANGLES.format(inputs=PLAIN_INPUT, p="0 1 2 0 2 3"),
    "polylist": f'<polylist count="1" material="m">{PLAIN_INPUT}<vcount>4</vcount><p>0 1 2 3</p></polylist>',
    "mixed polylist": f'<polylist count="2" material="m">{PLAIN_INPUT}<vcount>3 3</vcount>'
    "<p>0 1 2 0 2 3</p></polylist>",
    "polygons": f'<polygons count="1" material="m">{PLAIN_INPUT}<p>0 1 2 3</p></polygons>',
}


@pytest.mark.parametrize("primitive", PRIMITIVES.values(), ids=PRIMITIVES)
def test_every_primitive_covers_the_square_and_faces_up(tmp_path: Path, primitive: str) -> None:
    (part,) = read_collada(write(tmp_path, document(primitive)))
    assert area(part.corners) == pytest.approx(2.0)
    normals = np.cross(part.corners[:, 1] - part.corners[:, 0], part.corners[:, 2] - part.corners[:, 0])
    assert np.all(normals[:, 2] > 0.0)
    assert part.diffuse.rgba == pytest.approx([0.2, 0.4, 0.6, 1.0])


def test_unit_scales_to_metres(tmp_path: Path) -> None:
    asset = '<unit meter="0.01"/><up_axis>Z_UP</up_axis>'
    (part,) = read_collada(write(tmp_path, document(PRIMITIVES["triangles"], asset=asset)))
    assert part.corners.reshape(-1, 3).max(axis=0) == pytest.approx([0.01, 0.02, 0.0])


@pytest.mark.parametrize("up_axis", ["Z_UP", "Y_UP", "X_UP"])
def test_up_axis_does_not_turn_the_mesh(tmp_path: Path, up_axis: str) -> None:
    path = write(tmp_path, document(PRIMITIVES["triangles"], asset=f"<up_axis>{up_axis}</up_axis>"))
    (part,) = read_collada(path)
    assert part.corners[0, 2] == pytest.approx([1.0, 2.0, 0.0])


@pytest.mark.parametrize(
    ("transform", "corner"),
    [
        ("<matrix>1 0 0 5  0 1 0 6  0 0 1 7  0 0 0 1</matrix>", (6.0, 8.0, 7.0)),
        ("<translate>5 0 0</translate><rotate>0 0 1 90</rotate>", (3.0, 1.0, 0.0)),
        ("<rotate>0 0 1 90</rotate><translate>5 0 0</translate>", (-2.0, 6.0, 0.0)),
        ("<scale>2 3 1</scale>", (2.0, 6.0, 0.0)),
    ],
)
def test_node_transforms_apply_in_file_order(tmp_path: Path, transform: str, corner: tuple[float, ...]) -> None:
    (part,) = read_collada(write(tmp_path, document(PRIMITIVES["triangles"], transform=transform)))
    assert part.corners[0, 2] == pytest.approx(corner)


def test_mirrored_surface_still_faces_outwards(tmp_path: Path) -> None:
    """The square seen in the mirror x -> -x still faces up."""
    text = document(PRIMITIVES["triangles"], transform="<scale>-1 1 1</scale>")
    (part,) = read_collada(write(tmp_path, text))
    normals = np.cross(part.corners[:, 1] - part.corners[:, 0], part.corners[:, 2] - part.corners[:, 0])
    assert np.all(normals[:, 2] > 0.0)


def test_texture_colours_each_triangle(tmp_path: Path) -> None:
    """Left half red, right half blue; one triangle looks at each half."""
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:, :4, 0] = pixels[:, 4:, 2] = 255
    Image.fromarray(pixels).save(tmp_path / "picture.png")
    source = (
        '<source id="t"><float_array id="ta" count="4">0.2 0.5 0.8 0.5</float_array>'
        '<technique_common><accessor source="#ta" count="2" stride="2"/></technique_common></source>'
    )
    inputs = PLAIN_INPUT + '<input semantic="TEXCOORD" source="#t" offset="1" set="0"/>'
    primitive = TRIANGLES.format(inputs=inputs, p="0 0 1 0 2 0  0 1 2 1 3 1")
    text = document(primitive, diffuse='<texture texture="samp" texcoord="UV"/>', extra_source=source)
    (part,) = read_collada(write(tmp_path, text))
    colours = sorted(tuple(np.asarray(mesh.rgba).round(2).tolist()) for mesh in colored_meshes(part))
    assert colours == [(0.0, 0.0, 1.0, 1.0), (1.0, 0.0, 0.0, 1.0)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (document('<tristrips count="1"><p>0 1 2</p></tristrips>'), "tristrips"),
        (document(PRIMITIVES["triangles"], transform="<skew>0 0 0 0 0 0 0</skew>"), "skew"),
        (document(PRIMITIVES["triangles"]).replace('url="#g"', 'url="#lost"'), "#lost"),
        ("<robot/>", "COLLADA"),
        ("<COLLADA", "cannot read"),
    ],
)
def test_what_is_not_supported_is_one_clear_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(RobotDescriptionError, match=message) as caught:
        read_collada(write(tmp_path, text))
    assert "\n" not in str(caught.value)


def test_indices_beyond_the_vertices_are_a_damaged_mesh(tmp_path: Path) -> None:
    path = write(tmp_path, document(TRIANGLES.format(inputs=PLAIN_INPUT, p="0 1 9")))
    with pytest.raises(RobotDescriptionError, match="damaged"):
        read_mesh(path)
