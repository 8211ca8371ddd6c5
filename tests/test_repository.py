"""Promises about the repository as a whole: locked versions, complete metadata, no traces of a machine."""

import ast
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest

from quadlab.paths import CONF_DIR, checkout_dir

ROOT = checkout_dir() or Path()
TEXT = {".py", ".md", ".yaml", ".yml", ".toml", ".cff", ".txt", ".xml", ".cfg", ""}
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:home|Users|root|work|mnt|opt|tmp|scratch)/\w")
UNLISTED_MODULES = {"pinocchio": ["pin"]}
"""Modules that are found through a .pth file and not through the list of files of their distribution."""
PUBLIC_INDEX = "https://pypi.org/simple"

pytestmark = pytest.mark.skipif(checkout_dir() is None, reason="needs a source tree")


def _versioned_files() -> list[Path]:
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    try:
        listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (FileNotFoundError, subprocess.CalledProcessError):
        pytest.skip("needs a git repository")
    return [path for name in listed.splitlines() if (path := ROOT / name).is_file() and path.suffix in TEXT]


def test_no_file_mentions_a_path_of_somebodys_machine() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}"
        for path in _versioned_files()
        if path != Path(__file__).resolve()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if MACHINE_PATH.search(line)
    ]
    assert not found, "\n".join(found)


def _locked() -> dict[str, set[str]]:
    packages = tomllib.loads((ROOT / "uv.lock").read_text())["package"]
    versions: dict[str, set[str]] = {}
    for package in packages:
        if package["name"] != "quadlab":
            versions.setdefault(package["name"], set()).add(package["version"])
    return versions


def test_constraints_name_exactly_the_locked_versions() -> None:
    constraints: dict[str, set[str]] = {}
    for line in (ROOT / ".ci" / "constraints.txt").read_text().splitlines():
        name, version = line.split(";")[0].strip().split("==")
        constraints.setdefault(name, set()).add(version)
    assert constraints == _locked(), "run make lock"


def _declared() -> set[str]:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"].values()
    requirements = [*project["dependencies"], *(requirement for extra in extras for requirement in extra)]
    return {re.split(r"[<>=\[ ]", requirement)[0].lower() for requirement in requirements}


def test_lock_holds_every_dependency_that_the_project_declares() -> None:
    assert _declared() <= set(_locked()), "run make lock"


def test_lock_comes_from_the_public_index_alone() -> None:
    packages = tomllib.loads((ROOT / "uv.lock").read_text())["package"]
    sources = {source for package in packages if package["name"] != "quadlab" for source in package["source"].values()}
    assert sources == {PUBLIC_INDEX}


def test_citation_and_package_agree_on_the_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert f"version: {project['version']}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"## {project['version']}" in (ROOT / "CHANGELOG.md").read_text()


def _imports_of(path: Path) -> set[str]:
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
    return {name.split(".")[0] for name in names} - sys.stdlib_module_names - {"quadlab"}


def test_every_third_party_import_is_a_declared_dependency() -> None:
    provided = {**metadata.packages_distributions(), **UNLISTED_MODULES}
    folders = ("quadlab", "experiments", "paper_figures", "tests")
    own = {*folders, *(path.stem for folder in ("tests", "experiments") for path in (ROOT / folder).rglob("*.py"))}
    for path in [path for folder in folders for path in (ROOT / folder).rglob("*.py")]:
        for name in _imports_of(path) - own:
            distributions = {item.lower().replace("_", "-") for item in provided.get(name, [name])}
            message = f"{path.relative_to(ROOT)} imports {name}, which pyproject.toml does not declare"
            assert distributions & _declared(), message


def test_configuration_folder_is_found() -> None:
    assert (CONF_DIR / "trial.yaml").is_file()
