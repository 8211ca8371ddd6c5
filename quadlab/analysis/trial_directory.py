"""What a trial leaves in its directory."""

from pathlib import Path

from quadlab.errors import LogError
from quadlab.trials.recording.recorder import part_path
from quadlab.trials.recording.recover import default_target
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.result import RESULT_FILE, read_result


def find_log(directory: Path) -> Path:
    """Return the path of the log in ``directory``: the trial's own, else one that ``quadlab recover`` rescued.

    What was rescued belongs to a trial that did not end: beside a result it is of an earlier attempt, and not returned.

    Raises:
        LogError: if there is none; says what is there instead.
    """
    path = directory / LOG_FILE
    if path.is_file():
        return path
    if (directory / RESULT_FILE).is_file():
        result = read_result(directory)
        raise LogError(f"{directory}: no {LOG_FILE}, nothing was recorded: {result.status} ({result.status_reason})")
    rescued, part = default_target(path), part_path(path)
    if rescued.is_file():
        return rescued
    if part.is_file():
        raise LogError(f"{directory}: no {LOG_FILE}, but a trial that did not end; run 'quadlab recover {part}'")
    if not directory.is_dir():
        raise LogError(f"{directory}: no such directory; expected that of a trial, with a {LOG_FILE} in it")
    present = ", ".join(sorted(entry.name for entry in directory.iterdir())) or "nothing"
    raise LogError(f"{directory}: no {LOG_FILE} in it; expected the directory of a trial, found {present}")
