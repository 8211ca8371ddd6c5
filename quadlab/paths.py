"""Where quadlab finds its own files, from a checkout and from an installed wheel alike."""

from pathlib import Path

PACKAGE_DIR = Path(__file__).resolve().parent
"""The folder of the package."""


def _find_conf_dir() -> Path:
    """Return ``conf/``: inside the package in a wheel, beside the package in a checkout."""
    inside, beside = PACKAGE_DIR / "conf", PACKAGE_DIR.parent / "conf"
    return inside if inside.is_dir() else beside


CONF_DIR = _find_conf_dir()
"""The folder of all configuration files."""


def checkout_dir() -> Path | None:
    """Return the root of the source tree that quadlab runs from, or None if it was installed from a wheel."""
    root = PACKAGE_DIR.parent
    return root if (root / "pyproject.toml").is_file() and (root / "conf").is_dir() else None
