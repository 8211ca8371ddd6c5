"""Throw broken overrides and YAML files at the configuration: each must be accepted or refused in clear lines.

    python experiments/fuzz_configuration.py [--cases 10000] [--seed 0]

Exit code 1 if anything but a ConfigurationError comes out, or an empty or unending line.
"""

import argparse
import random
import sys
import tempfile
from functools import partial
from pathlib import Path

from omegaconf import OmegaConf

from quadlab.errors import ConfigurationError
from quadlab.trials.compose import compose_document, plain_values, split_document

VALUES = (
    *("", "null", "-1", "0", "1e400", "nan", ".inf", "true", "abc", "[]", "{}", "[1,", "{a: 1", "'", '"', "${x}", "-"),
    *(
        "${seed",
        "${oc.env:HOME}",
        "???",
        "1,2",
        "range(3)",
        "\\\\",
        "é",
        "😀",
        "a=b",
        "~",
        "*x",
        "!!python/object:x",
        "\t",
    ),
    *("[0,0]", "[1,2,3]", "[[1]]", "{kind: x}", "999999999999999999999", "x" * 500),
)
LONGEST_LINE = 2000
LONGEST_CASE = 200
OVERRIDE_SHARE = 0.7


def keys(values: object, prefix: str = "") -> list[str]:
    """Return all dotted keys of a composed configuration."""
    if isinstance(values, dict):
        items = [(str(key), value) for key, value in values.items()]
    elif isinstance(values, list):
        items = [(str(number), value) for number, value in enumerate(values)]
    else:
        return [prefix]
    below = [name for key, value in items for name in keys(value, f"{prefix}.{key}" if prefix else key)]
    return [prefix, *below] if prefix else below


def broken_override(draw: random.Random, known: list[str]) -> str:
    """Return an override that is probably wrong."""
    key = draw.choice(known)
    if draw.random() < 0.3:
        place = draw.randrange(len(key))
        key = key[:place] + draw.choice("x.~+= []{}é0") + key[place + draw.randrange(2) :]
    return draw.choice(("", "", "", "+", "++", "~")) + key + draw.choice(("=", "=", "=", "")) + draw.choice(VALUES)


def broken_yaml(draw: random.Random, text: str) -> str:
    """Return ``text`` with a few places deleted, doubled or replaced."""
    for _ in range(draw.randrange(1, 4)):
        start = draw.randrange(len(text))
        end = min(len(text), start + draw.randrange(1, 12))
        text = text[:start] + draw.choice(("", text[start:end] * 2, draw.choice(VALUES))) + text[end:]
    return text


def problem_with(overrides: list[str]) -> str | None:
    """Compose with overrides and return what is wrong with the answer, None if nothing."""
    try:
        split_document(compose_document(overrides))
    except ConfigurationError as error:
        return _problem_with_message(str(error))
    return None


def problem_with_file(text: str, folder: Path) -> str | None:
    """Merge a YAML file as an experiment is merged, validate and return what is wrong with the answer."""
    path = folder / "fuzzed" / "broken.yaml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return problem_with([f"hydra.searchpath=[file://{folder}]", "+fuzzed@_global_=broken"])


def _problem_with_message(message: str) -> str | None:
    lines = message.splitlines()
    if not lines or not all(line.strip() for line in lines):
        return f"an empty line in {message!r}"
    return next((f"a line of {len(line)} characters" for line in lines if len(line) > LONGEST_LINE), None)


class Attempt:
    """A context in which every exception becomes a finding: here all of them are."""

    def __init__(self, found: list[str], case: str) -> None:
        self._found, self._case = found, case

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> bool:
        if isinstance(error, Exception):
            self._found.append(f"{self._case!r}: {type(error).__name__}: {error}")
        return isinstance(error, Exception)


def fuzz(cases: int, seed: int) -> list[str]:
    """Return one line for each case that was answered badly."""
    draw = random.Random(seed)
    document = compose_document()
    known, text = keys(plain_values(document)), OmegaConf.to_yaml(document)
    found: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(cases):
            if draw.random() < OVERRIDE_SHARE:
                case = broken_override(draw, known)
                answer = partial(problem_with, [case])
            else:
                case = broken_yaml(draw, text)
                answer = partial(problem_with_file, case, Path(folder))
            with Attempt(found, case[:LONGEST_CASE]):
                found += [f"{case!r}: {problem}" for problem in [answer()] if problem]
    return found


def main() -> int:
    """Fuzz, print what was answered badly and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    found = fuzz(options.cases, options.seed)
    sys.stdout.write("".join(f"{line}\n" for line in found))
    sys.stdout.write(f"{options.cases} cases, {len(found)} answered badly\n")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
