"""The manifest names everything that a trial's numbers depend on."""

import json
import subprocess
from pathlib import Path

from quadlab.trials.compose import compose_trial
from quadlab.trials.identity import trial_id
from quadlab.trials.manifest import collect_manifest, git_state, lock_hash, sha256


def test_manifest_is_json_and_complete() -> None:
    config = compose_trial(["seed=4"])
    manifest = json.loads(json.dumps(collect_manifest(config), allow_nan=False))
    assert manifest["trial_id"] == trial_id(config)
    assert manifest["seeds"] == {"trial": 4}
    assert len(manifest["model_sha256"]) == 64
    assert manifest["packages"]["mujoco"]
    assert manifest["cpu"]["cores"] >= 1
    assert all(library["num_threads"] >= 1 for library in manifest["blas"])
    assert {"git", "lock_sha256", "argv", "python", "platform", "environment", "quadlab_version"} <= set(manifest)


def test_manifest_of_a_rerun_is_the_same() -> None:
    assert collect_manifest(compose_trial()) == collect_manifest(compose_trial())


def test_model_hash_follows_the_model() -> None:
    changed = compose_trial(["+robot.overrides.damping_nms={LF_HAA: 0.1}"])
    assert collect_manifest(changed)["model_sha256"] != collect_manifest(compose_trial())["model_sha256"]


def _git(folder: Path, *arguments: str) -> None:
    identity = ["-c", "user.name=somebody", "-c", "user.email=somebody@example.org"]
    subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)


def test_git_state_sees_commit_changes_and_new_files(tmp_path: Path) -> None:
    assert git_state.__wrapped__(tmp_path) is None
    _git(tmp_path, "init", "-q")
    (tmp_path / "code.py").write_text("a = 1\n")
    _git(tmp_path, "add", "code.py")
    _git(tmp_path, "commit", "-q", "-m", "first")
    clean = git_state.__wrapped__(tmp_path)
    assert clean is not None
    assert (len(clean["commit"]), clean["dirty"], clean["diff_sha256"]) == (40, False, None)
    (tmp_path / "code.py").write_text("a = 2\n")
    (tmp_path / "new.py").write_text("")
    changed = git_state.__wrapped__(tmp_path)
    assert changed is not None
    assert changed["dirty"]
    assert len(changed["diff_sha256"]) == 64
    assert changed["untracked"] == ["new.py"]


def test_git_state_outside_a_source_tree() -> None:
    assert git_state(None) is None


def test_lock_hash(tmp_path: Path) -> None:
    assert lock_hash.__wrapped__(tmp_path) is None
    (tmp_path / "uv.lock").write_bytes(b"locked")
    assert lock_hash.__wrapped__(tmp_path) == sha256(b"locked")
