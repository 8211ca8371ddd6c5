"""The results of many trials as one table."""

from pathlib import Path

import pandas as pd

from quadlab.errors import LogError
from quadlab.trials.result import RESULT_FILE, TrialResult, read_result

INDEX = "trial_id"


def read_trial_table(folder: Path | str) -> pd.DataFrame:
    """Return one row for each finished trial below ``folder``, indexed by ``trial_id`` and sorted by it.

    The columns are the fields of ``TrialResult``, failures included; a metric that does not exist is NaN.

    Raises:
        LogError: if ``folder`` holds no result, one of them cannot be read, or two have the same id.
    """
    folder = Path(folder)
    directories = sorted(path.parent for path in folder.rglob(RESULT_FILE))
    if not directories:
        raise LogError(f"{folder}: no {RESULT_FILE} in it or below; a trial writes one when it has finished")
    rows = [read_result(directory).model_dump(mode="json") for directory in directories]
    table = pd.DataFrame(rows, columns=list(TrialResult.model_fields)).set_index(INDEX).sort_index()
    twice = table.index[table.index.duplicated()]
    if len(twice):
        raise LogError(f"{folder}: {INDEX} '{twice[0]}' exists more than once; read one folder of results at a time")
    return table
