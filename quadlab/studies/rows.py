"""What one job of a study leaves: a flat row."""

from typing import Any, TypeAlias

Row: TypeAlias = dict[str, Any]
"""Its ``status`` first, then whatever the job measured."""

DIRECTORY = "directory"
"""Column of the folder, relative to that of the study, in which a job left its files."""
FAILURE = "status_reason"
"""Column of why a job ended as it did."""
LOG_HASH = "log_sha256"
"""Column of the hash of a trial's log, which may be deleted."""
