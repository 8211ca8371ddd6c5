"""Meshes: shape kept, cache harmless, errors clear."""

from pathlib import Path

import numpy as np
import pytest

from quadlab.errors import RobotDescriptionError
from quadlab.robots.description import description_folder
from quadlab.simulation.rendering.mesh import TriangleMesh, compact
from quadlab.simulation.rendering.mesh_cache import load_compact
from quadlab.simulation.rendering.mesh_files import read_mesh

ASCII_STL = """solid s
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid s
"""
OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n"


def anymal_base() -> Path:
    return description_folder() / "anymal_b_simple_description/meshes/base/anymal_base.dae"


def anymal_shank() -> Path:
    return description_folder() / "anymal_b_simple_description/meshes/shank/anymal_shank_l.dae"


def bounds(meshes: list[TriangleMesh]) -> np.ndarray:
    both = np.array([mesh.bounds for mesh in meshes])
    return np.array([both[:, 0].min(axis=0), both[:, 1].max(axis=0)])


def ball(count: int) -> TriangleMesh:
    """A latitude-longitude sphere of radius 1 m whose triangles do not share vertices."""
    angle, height = np.linspace(0, 2 * np.pi, count + 1), np.linspace(0, np.pi, count + 1)
    corners = []
    for i in range(count):
        for j in range(count):
            cell = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            p = [
                [np.sin(height[a]) * np.cos(angle[b]), np.sin(height[a]) * np.sin(angle[b]), np.cos(height[a])]
                for a, b in cell
            ]
            corners += [[p[0], p[2], p[1]], [p[0], p[3], p[2]]]
    flat = np.array(corners).reshape(-1, 3)
    return TriangleMesh(flat, np.arange(len(flat), dtype=np.int32).reshape(-1, 3), None)


@pytest.mark.parametrize("cell_m", [0.0, 0.05, 0.2])
def test_compact_keeps_the_shape_within_a_cell(cell_m: float) -> None:
    mesh = ball(40)
    (small,) = compact([mesh], cell_m)
    radius = np.linalg.norm(small.vertices, axis=1)
    assert np.all(np.abs(radius - 1.0) <= cell_m + 1e-9)
    assert len(small.vertices) < len(mesh.vertices) / 3
    assert set(np.unique(small.triangles)) == set(range(len(small.vertices)))


def test_compact_leaves_no_crack_between_colours() -> None:
    whole = ball(30)
    half = len(whole.triangles) // 2
    red, blue = (
        TriangleMesh(whole.vertices, whole.triangles[part], np.array(rgba))
        for part, rgba in ((slice(0, half), (1.0, 0, 0, 1)), (slice(half, None), (0, 0, 1.0, 1)))
    )
    joint = compact([whole], 0.15)[0]
    parts = compact([red, blue], 0.15)
    corners = {tuple(np.round(vertex, 9)) for mesh in parts for vertex in mesh.vertices}
    assert len(corners) <= len(joint.vertices)


@pytest.mark.parametrize(("name", "text", "triangles"), [("a.stl", ASCII_STL, 1), ("a.obj", OBJ, 2)])
def test_text_meshes(tmp_path: Path, name: str, text: str, triangles: int) -> None:
    (tmp_path / name).write_text(text)
    (mesh,) = read_mesh(tmp_path / name)
    assert len(mesh.triangles) == triangles
    assert mesh.bounds == pytest.approx(np.array([[0, 0, 0], [1, 1, 0]]))
    assert mesh.rgba is None


def test_binary_stl_of_solo_is_in_metres() -> None:
    folder = description_folder() / "solo_description/meshes/stl/solo12"
    size = np.ptp(bounds(read_mesh(folder / "solo_12_base.stl")), axis=0)
    assert 0.2 < size.max() < 0.6


@pytest.mark.parametrize("cell_m", [0.0, 0.004])
def test_anymal_base_has_the_size_of_its_trunk(tmp_path: Path, cell_m: float) -> None:
    """The trunk is about 0.6 m long, symmetric left and right, and in clearly more than one colour."""
    meshes = load_compact(anymal_base(), cell_m, tmp_path)
    low, high = bounds(meshes)
    assert high[0] - low[0] == pytest.approx(0.60, abs=0.02)
    assert high[1] + low[1] == pytest.approx(0.0, abs=0.01)
    assert len({tuple(np.asarray(mesh.rgba).round(2)) for mesh in meshes if mesh.rgba is not None}) >= 4


def test_cache_gives_the_same_mesh_and_writes_once(tmp_path: Path) -> None:
    fresh = load_compact(anymal_shank(), 0.01, tmp_path)
    (file,) = tmp_path.rglob("*.npz")
    written = file.stat().st_mtime_ns
    again = load_compact(anymal_shank(), 0.01, tmp_path)
    assert file.stat().st_mtime_ns == written
    assert [len(mesh.triangles) for mesh in again] == [len(mesh.triangles) for mesh in fresh]
    assert bounds(again) == pytest.approx(bounds(fresh), abs=1e-6)
    assert not list(tmp_path.rglob("*.part"))


@pytest.mark.parametrize("size", [0, 100])
def test_damaged_cache_is_replaced(tmp_path: Path, size: int) -> None:
    fresh = load_compact(anymal_shank(), 0.01, tmp_path)
    (file,) = tmp_path.rglob("*.npz")
    file.write_bytes(file.read_bytes()[:size])
    assert len(load_compact(anymal_shank(), 0.01, tmp_path)) == len(fresh)
    assert file.stat().st_size > 100


def test_cache_folder_that_cannot_be_made_is_no_error(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    assert load_compact(anymal_shank(), 0.02, blocked)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.ply", b"ply", "known: .dae, .stl, .obj"),
        ("a.stl", b"solid nothing", "no triangles"),
        ("a.stl", b"\xff\xfe\x00", "damaged"),
        ("a.obj", b"v 0 0 zero\nf 1 1 1\n", "damaged"),
        ("lost.dae", None, "does not exist"),
    ],
)
def test_unreadable_meshes_say_why(tmp_path: Path, name: str, content: bytes | None, message: str) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(RobotDescriptionError, match=message):
        load_compact(tmp_path / name, 0.01, tmp_path)
