"""A table as Markdown for people and as LaTeX for papers."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

_LATEX_SPECIAL = str.maketrans(
    {
        "&": r"\&",
        "%": r"\%",
        "$": r"\$",
        "#": r"\#",
        "_": r"\_",
        "{": r"\{",
        "}": r"\}",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
        "\\": r"\textbackslash{}",
        "<": r"\textless{}",
        ">": r"\textgreater{}",
        "|": r"\textbar{}",
    }
)
_MINUS = re.compile(r"(?<![^\s(\[=/,])-(?=[.\d])|(?<=\de)-(?=\d)")
"""A hyphen that is the sign of a number or of its exponent."""


@dataclass(frozen=True)
class TextTable:
    """Words in rows and columns.

    Attributes:
        header: of each column.
        rows: as long as the header each.
        labels: number of columns at the left that hold words; the others hold numbers.
    """

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    labels: int

    def markdown(self) -> str:
        """Return the table as Markdown."""
        rule = "|" + "---|" * self.labels + "--:|" * (len(self.header) - self.labels)
        return "\n".join([_markdown_line(self.header), rule, *map(_markdown_line, self.rows)]) + "\n"

    def latex(self) -> str:
        """Return the table as a LaTeX tabular; needs the package booktabs."""
        columns = "l" * self.labels + "r" * (len(self.header) - self.labels)
        lines = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", _latex_line(self.header), r"\midrule"]
        return "\n".join([*lines, *map(_latex_line, self.rows), r"\bottomrule", r"\end{tabular}"]) + "\n"


def _markdown_line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def _latex_line(cells: Sequence[str]) -> str:
    return " & ".join(_MINUS.sub("$-$", cell.translate(_LATEX_SPECIAL)) for cell in cells) + r" \\"
