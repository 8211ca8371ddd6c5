"""Exceptions for mistakes of the caller; outcomes of a trial are values, not exceptions."""


class QuadlabError(Exception):
    """Base of every error that quadlab raises on purpose.

    The message is one line: what was wrong, what was expected, what exists.
    """


class ConfigurationError(QuadlabError):
    """A configuration that cannot describe a trial (exit code 2 at the command line)."""


class RobotDescriptionError(ConfigurationError):
    """A robot description that cannot be loaded or does not have the named parts."""


class PlanningProblemError(QuadlabError):
    """A planning problem that is malformed before any solver sees it."""


class LogError(QuadlabError):
    """A trial log that is missing, incomplete or not one of ours."""


class PoolError(QuadlabError):
    """Processes that cannot be started."""


class MissingDependencyError(QuadlabError):
    """A system library or optional package that the requested action needs."""


def os_error_line(error: OSError) -> str:
    """Return "path: reason" for a full disk, say, or a folder that nobody may write to; one line without a path too."""
    if error.filename is not None and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return one_line(str(error)) or type(error).__name__


def one_line(text: str) -> str:
    """Return the lines of ``text`` in one, parted by semicolons."""
    return "; ".join(line.strip() for line in text.splitlines() if line.strip())
