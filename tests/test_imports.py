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
    "sweeps",
    "analysis",
    "plotting",
    "studies",
)
BASE = {"command_line", "errors", "configuration", "constants", "paths", "jit", "yaml_text"}
OWNERS = {"mujoco": {"simulation"}, "omegaconf": {"trials", "sweeps"}, "hydra": {"trials", "sweeps"}}
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


def _against_the_stream(path: Path) -> set[str]:
    folder = _folder(path)
    used = {name.split(".")[1] for name in _imported(path) if name.startswith("quadlab.")} - {folder, "__version__"}
    if folder in ORDER:
        return used - BASE - set(ORDER[: ORDER.index(folder)])
    return used - BASE if folder in BASE else set()


def test_imports_go_upstream() -> None:
    found = {str(path.relative_to(PACKAGE)): sorted(wrong) for path in FILES if (wrong := _against_the_stream(path))}
    assert not found


@pytest.mark.parametrize("package", OWNERS)
def test_outside_package_stays_with_its_owners(package: str) -> None:
    users = {_folder(path) for path in FILES if package in {name.split(".")[0] for name in _imported(path)}}
    assert users <= OWNERS[package]


def test_every_folder_has_its_place_in_the_order() -> None:
    folders = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    assert folders == set(ORDER)
