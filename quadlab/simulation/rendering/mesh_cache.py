"""Meshes as small arrays, kept between runs in the user's cache folder."""

import hashlib
import os
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from quadlab.simulation.rendering.mesh import TriangleMesh, compact
from quadlab.simulation.rendering.mesh_files import read_mesh

FORMAT = 2
"""Goes up when the content of a cache file changes its meaning."""


def cache_folder() -> Path:
    """Return ``$XDG_CACHE_HOME/quadlab`` or ``~/.cache/quadlab``; it need not exist."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "quadlab"


def load_compact(path: Path, cell_m: float, folder: Path | None = None) -> list[TriangleMesh]:
    """Return the meshes of a file with vertices merged in cells of ``cell_m``, from the cache if it has them.

    A cache that cannot be read or written is not used; the result is the same, only slower.

    Args:
        path: mesh file (.dae, .stl, .obj).
        cell_m: edge of the cells in [m]; 0 keeps every vertex.
        folder: cache folder; None for the user's.

    Raises:
        RobotDescriptionError: if the file is missing, damaged or of an unknown kind.
    """
    if not path.is_file():
        return read_mesh(path)
    key = hashlib.sha256(path.read_bytes() + f"|{path.suffix}|{cell_m!r}|{FORMAT}".encode()).hexdigest()[:24]
    file = (folder or cache_folder()) / "meshes" / f"{path.stem}-{key}.npz"
    cached = _load(file)
    if cached is not None:
        return cached
    meshes = compact(read_mesh(path), cell_m)
    _store(file, meshes)
    return meshes


def _load(file: Path) -> list[TriangleMesh] | None:
    try:
        with np.load(file) as content:
            count = len(content.files) // 3
            parts = [[content[f"{name}{k}"] for name in ("vertices", "triangles", "rgba")] for k in range(count)]
    except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile):
        return None
    return [TriangleMesh(v.astype(float), t, rgba.astype(float) if rgba.size else None) for v, t, rgba in parts]


def _store(file: Path, meshes: list[TriangleMesh]) -> None:
    """Write beside the file and rename, so that no reader sees half a file."""
    arrays: dict[str, Any] = {}
    for k, mesh in enumerate(meshes):
        arrays[f"vertices{k}"] = mesh.vertices.astype(np.float32)
        arrays[f"triangles{k}"] = mesh.triangles
        arrays[f"rgba{k}"] = np.zeros(0) if mesh.rgba is None else mesh.rgba
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(suffix=".part", dir=file.parent)
    except OSError:
        return
    try:
        with os.fdopen(handle, "wb") as stream:
            np.savez(stream, **arrays)
        Path(part).replace(file)
    except OSError:
        Path(part).unlink(missing_ok=True)
