"""The table of artefacts in the README, between two marks."""

from collections.abc import Sequence
from pathlib import Path

from paper_figures.summary import Judged
from quadlab.errors import ConfigurationError
from quadlab.trials.files import write_text

BEGIN, END = "<!-- artefacts: begin -->", "<!-- artefacts: end -->"


def readme_table(judged: Sequence[Judged]) -> str:
    """Return a Markdown table with one line an artefact: figure, command, verdict."""
    lines = ["| artefact | shows | command | verdict |", "|---|---|---|---|"]
    for entry in judged:
        script, artefact = entry.script, entry.script.artefact
        source = (
            artefact.source if entry.problem else f"[{artefact.source}](paper_figures/{script.paper}/{script.name}.png)"
        )
        lines.append(f"| {source} | {artefact.title} | `{script.command}` | {entry.verdict} |")
    return "\n".join(lines)


def with_table(text: str, judged: Sequence[Judged]) -> str:
    """Return the README's ``text`` with its table renewed.

    Raises:
        ConfigurationError: if a mark is missing.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ConfigurationError(f"README.md: expected the marks '{BEGIN}' and '{END}'")
    return f"{before}{BEGIN}\n{readme_table(judged)}\n{END}{after}"


def write_readme(path: Path, judged: Sequence[Judged]) -> Path:
    """Renew the table in the README at ``path`` and return it."""
    write_text(path, with_table(path.read_text(encoding="utf-8"), judged))
    return path
