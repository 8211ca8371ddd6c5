"""Imports go only upstream, and the packages that pull in the outside world stay where they belong."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import quadlab

PACKAGE = Path(quadlab.__file__).parent
ORDER = (
    "geometry",
    "robots",
    "gaits",
    "planners",
    "estimation",
    "controllers",
    "simulation",
    "trials",
    "analysis",
    "plotting",
)
BASE = {"errors", "configuration", "paths"}
OWNERS = {"mujoco": "simulation", "omegaconf": "trials", "hydra": "trials"}
FILES = sorted(PACKAGE.rglob("*.py"))


def _folder(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def _imported(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: relative import"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_upstream(path: Path) -> None:
    folder = _folder(path)
    used = {name.split(".")[1] for name in _imported(path) if name.startswith("quadlab.")} - {folder, "__version__"}
    if folder in ORDER:
        allowed = BASE | set(ORDER[: ORDER.index(folder)])
        assert used <= allowed, f"{folder} imports {sorted(used - allowed)}"
    elif folder in BASE:
        assert used <= BASE


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_outside_packages_have_one_owner(path: Path) -> None:
    for package in {name.split(".")[0] for name in _imported(path)} & set(OWNERS):
        assert _folder(path) == OWNERS[package], f"only quadlab/{OWNERS[package]} imports {package}"


def test_every_folder_has_its_place_in_the_order() -> None:
    folders = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert folders == set(ORDER)
