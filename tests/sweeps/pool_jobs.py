"""What the tests let workers do; found by module and name, as every job is."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path


def square(number: int) -> int:
    return number * number


def fail(message: str) -> None:
    raise ValueError(message)


def leave(code: int) -> None:
    os._exit(code)


def kill_self(signal_number: int) -> None:
    sys.stderr.write("last words\n")
    os.kill(os.getpid(), signal_number)


def sleep(seconds: float) -> None:
    time.sleep(seconds)


def kill_server() -> None:
    os.kill(os.getppid(), signal.SIGKILL)
    time.sleep(60)


def allocate(gibibytes: float) -> int:
    return len(bytearray(int(gibibytes * 1024**3)))


def note_pid(folder: Path) -> None:
    (folder / str(os.getpid())).touch()
    time.sleep(60)


def start_grandchild(folder: Path) -> None:
    process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    (folder / str(process.pid)).touch()
    process.wait()


def parent() -> int:
    return os.getppid()


def break_preload() -> None:
    os._exit(3)


def make_lambda() -> object:
    return lambda: None
