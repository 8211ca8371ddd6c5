"""What all commands have in common: exit codes, and one line instead of a traceback for what was wrong."""

import argparse
import os
import sys
from collections.abc import Callable

from quadlab.errors import PoolError, QuadlabError, os_error_line

EXIT_OK, EXIT_FAILED, EXIT_USAGE, EXIT_INTERRUPTED = 0, 1, 2, 130


def exit_code(command: Callable[[], int], interrupted: str = "interrupted") -> int:
    """Run a command and return its exit code; what stops it is told on standard error.

    A reader of the output that has gone, as ``head`` does, is no mistake: it ends the command without a word.

    Args:
        command: returns its exit code.
        interrupted: what to say when Ctrl-C ended it.
    """
    try:
        code = command()
        sys.stdout.flush()  # here, where a reader that has gone is no traceback yet
    except KeyboardInterrupt:
        complain(interrupted)
        return EXIT_INTERRUPTED
    except PoolError as error:  # no mistake of whoever asked
        complain(str(error))
        return EXIT_FAILED
    except QuadlabError as error:
        complain(str(error))
        return EXIT_USAGE
    except BrokenPipeError:
        _close_stdout()
        return EXIT_FAILED
    except OSError as error:
        complain(os_error_line(error))
        return EXIT_FAILED
    return code


def positive_number(text: str) -> int:
    """Return the whole number above 0 that an option was given.

    Raises:
        ArgumentTypeError: if it is none.
    """
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"expected a whole number above 0 (got '{text}')")
    return int(text)


def complain(problem: str) -> None:
    """Print what is wrong to standard error."""
    for line in problem.splitlines():
        sys.stderr.write(f"quadlab: {line}\n")


def _close_stdout() -> None:
    """Send what is left of the output nowhere, so that Python does not try again to write it when it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
