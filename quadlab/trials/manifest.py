"""Provenance of a trial: which code, which packages, which machine, which seed, which robot model."""

import hashlib
import os
import platform
import subprocess
import sys
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_info

from quadlab import __version__
from quadlab.paths import CONF_DIR, checkout_dir
from quadlab.robots.description import load_urdf_text
from quadlab.trials.config import TrialConfig
from quadlab.trials.identity import trial_id

MANIFEST_FILE = "manifest.json"
MANIFEST_SCHEMA_VERSION = 1

_BLAS_FIELDS = ("internal_api", "version", "num_threads", "architecture", "threading_layer", "prefix")
_CPU_FLAGS = frozenset({"sse4_2", "avx", "avx2", "fma", "avx512f", "avx512_vnni"})
"""Instruction sets that change the order of floating-point sums."""
_CODE = ("--", ".", ":(exclude)results", *(f":(exclude)paper_figures/**/*.{kind}" for kind in ("csv", "pdf", "png")))
_ENVIRONMENT = ("MUJOCO_GL", "PYTHONHASHSEED", "OPENBLAS_CORETYPE", "MKL_CBWR")


def note_code() -> None:
    """Keep for this process, and those forked from it, of which code it is: what was imported stays as it was then."""
    git_state(checkout_dir())
    lock_hash(checkout_dir())
    installed_packages()


def collect_manifest(config: TrialConfig) -> dict[str, Any]:
    """Return everything but the configuration that a trial's numbers depend on, ready for JSON.

    Call it where the trial runs: BLAS threads are those of this moment. There is no time of day in it: it is attached
    to the log, and a rerun gives the same log.
    """
    return {
        "schema_version": MANIFEST_SCHEMA_VERSION,
        "trial_id": trial_id(config),
        "quadlab_version": __version__,
        "git": git_state(checkout_dir()),
        "lock_sha256": lock_hash(checkout_dir()),
        "model_sha256": sha256(load_urdf_text(config.robot).encode()),
        "seeds": {"trial": config.seed},
        "argv": sys.argv,
        "python": sys.version,
        "platform": platform.platform(),
        "libc": " ".join(platform.libc_ver()),
        "cpu": processor(),
        "blas": linear_algebra(),
        "environment": thread_environment(),
        "packages": installed_packages(),
    }


def sha256(content: bytes) -> str:
    """Return the SHA-256 of ``content`` in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


@cache
def git_state(root: Path | None) -> dict[str, Any] | None:
    """Return commit, whether the code differs from it, hash of the difference and untracked files.

    As of the first call in a process: a later commit changes nothing of what was imported. Results and the figures that
    are drawn from them are no code: they change while they are made.

    Args:
        root: a source tree, or None for an installed wheel.

    Returns:
        None where there is no repository (a wheel, an unpacked archive) or no git.
    """
    head = _git(root, "rev-parse", "HEAD")
    if head is None:
        return None
    difference = _git(root, "diff", "HEAD", "--binary", *_CODE) or b""
    status = (_git(root, "status", "--porcelain=v1", *_CODE) or b"").decode()
    return {
        "commit": head.decode().strip(),
        "dirty": bool(status.strip()),
        "diff_sha256": sha256(difference) if difference else None,
        "untracked": [line[3:] for line in status.splitlines() if line.startswith("??")],
    }


def _git(root: Path | None, *arguments: str) -> bytes | None:
    if root is None or not (root / ".git").exists():
        return None
    try:
        return subprocess.run(["git", *arguments], cwd=root, capture_output=True, check=True).stdout
    except (FileNotFoundError, subprocess.CalledProcessError):
        return None


@cache
def lock_hash(root: Path | None) -> str | None:
    """Return the hash of ``uv.lock``, or None in an installed wheel; as of the first call in a process."""
    lock = (root or CONF_DIR) / "uv.lock"
    return sha256(lock.read_bytes()) if lock.is_file() else None


def processor() -> dict[str, Any]:
    """Return model, instruction sets that matter for rounding, and number of usable cores."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.is_file() else []
    fields = dict(_pair(line) for line in lines)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    flags = _CPU_FLAGS & set(fields.get("flags", "").split())
    return {"model": fields.get("model name", platform.processor()), "flags": sorted(flags), "cores": cores}


def _pair(line: str) -> tuple[str, str]:
    key, _, value = line.partition(":")
    return key.strip(), value.strip()


def linear_algebra() -> list[dict[str, Any]]:
    """Return the libraries that use threads, sorted: the order in which they were loaded varies."""
    libraries = [{key: library.get(key) for key in _BLAS_FIELDS} for library in threadpool_info()]
    return sorted(libraries, key=lambda library: (str(library["prefix"]), str(library["version"])))


def thread_environment() -> dict[str, str]:
    """Return the environment variables that set threads and other sources of difference."""
    names = [name for name in os.environ if name.endswith("_NUM_THREADS") or name in _ENVIRONMENT]
    return {name: os.environ[name] for name in sorted(names)}


@cache
def installed_packages() -> dict[str, str]:
    """Return the version of every installed distribution, by name; as of the first call in a process."""
    found = {distribution.name: distribution.version for distribution in metadata.distributions()}
    return dict(sorted(found.items(), key=lambda item: item[0].lower()))
