"""Limits of a study, of which every one was found, and how they are told."""

from collections.abc import Sequence

import pandas as pd

from quadlab.analysis.study_results import StudyResults
from quadlab.errors import LogError


def known_limits(results: StudyResults, study: str, columns: Sequence[str] = ()) -> pd.DataFrame:
    """Return one row a search: its levels and the largest value survived, empty where even the smallest was not.

    Raises:
        LogError: if the study has not been run, searches for nothing, lacks one of ``columns``, or errors left some
            limits unknown.
    """
    limits = results.limits(study, columns)
    unknown = int(limits["unknown"].notna().sum()) if "unknown" in limits else 0
    if unknown:
        raise LogError(
            f"{study}/limits.csv: {unknown} of {len(limits)} limits are unknown since trials ended in an error; "
            f"python experiments/run_study.py {study} runs these again"
        )
    return limits


def limit_text(value: float, digits: int) -> str:
    """Return the limit in words: one of zero is that not even the smallest value tried was survived."""
    return f"{value:.{digits}f}" if value > 0.0 else "none"
