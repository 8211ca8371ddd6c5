"""Winkler 2017, Table I: size of the nonlinear program and time to solve it, eight motions."""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.study_origin import processor
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.planners.vertex_zmp.table_one import TABLE_ONE
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure

STUDY = "winkler2017_table1"
CAPTION = (
    "Sizes of the nonlinear programs and wall times of solving them, the paper's beside ours in both transcriptions; "
    "each was solved once, nothing is simulated."
)
ARTEFACT = Artefact(
    "W-TAB1", "Winkler 2017, Table I", "Sizes and solve times of the nonlinear programs", (STUDY,), CAPTION
)
PAPER_PROCESSOR = "Intel Core i7, 2.8 GHz, four cores"
SLOWER = "Another machine; compare with bench_planners.py on a quiet one."


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: sizes and solve times, the printed ones first, then ours in both transcriptions."""
    header = (
        ("", "variables", "", "", "constraints", "", "", "solve [s]", "", ""),
        ("motion", *(("paper", "Ipopt", "reduced") * 3)),
    )
    rows = [
        (
            row["case"],
            *(f"{row[f'variables_{name}']:.0f}" for name in ("printed", "paper", "fast")),
            *(f"{row[f'constraints_{name}']:.0f}" for name in ("printed", "paper", "fast")),
            *(f"{row[f'solve_s_{name}']:.2g}" for name in ("printed", "paper", "fast")),
        )
        for _, row in numbers(results).iterrows()
    ]
    notes = (
        f"paper: as printed, {PAPER_PROCESSOR}; Ipopt: its formulation here, with CasADi and Ipopt, but",
        f"{load_nodes()};",
        f"reduced: ours, with its own solver. Wall times without building, {processor(STUDY, results)}.",
    )
    return table_figure(TableText(header, tuple(rows), notes=notes))


def load_nodes() -> str:
    """Return where the nodes of the loads are, which the paper puts every 20 ms."""
    from quadlab.planners.vertex_zmp.paper.transcription import NODES_PER_POLYNOMIAL  # noqa: PLC0415 - loads CasADi

    gaits = {case.gait: 1e3 * case.polynomial_s / (NODES_PER_POLYNOMIAL - 1) for case in TABLE_ONE}
    return f"load nodes every {', '.join(f'{period:g} ms ({gait})' for gait, period in gaits.items())} instead of 20 ms"


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a motion: what is printed, then sizes and times of both transcriptions here."""
    table = results.table(STUDY)
    rows = []
    for case in TABLE_ONE:
        row: dict[str, object] = {
            "case": case.name,
            "variables_printed": case.paper_variables,
            "constraints_printed": case.paper_constraints,
            "solve_s_printed": case.paper_ipopt_s,
        }
        for name in ("paper", "fast"):
            ours = table[(table["case"] == case.name) & (table["transcription"] == name)]
            row |= {f"{key}_{name}": ours[key].iloc[0] for key in ("variables", "constraints")}
            row[f"solve_s_{name}"] = 1e-3 * float(ours["solve_ms"].iloc[0])
            row[f"iterations_{name}"] = int(ours["iterations"].iloc[0])
        rows.append(row)
    return pd.DataFrame(rows)


def claims(results: StudyResults) -> list[Claim]:
    """Return that all motions are solved, and times and counts beside the printed ones."""
    table, every = numbers(results), results.table(STUDY)
    solved = int((every["status"] == "solved").sum())
    return [
        Claim("motions that are solved, both transcriptions", "8", f"{solved} of {len(every)}, a biped among them",
              verdict(holds=solved == len(every))),
        _times(table, "its formulation with Ipopt", "paper", "Building it is not counted. " + SLOWER),
        _times(table, "reduced program", "fast", SLOWER),
        Claim("variables of walk 16 and trot 16", "646 and 387",
              " and ".join(str(int(table["variables_paper"].iloc[place])) for place in (0, 2)),
              verdict(holds=bool((table["variables_paper"] == table["variables_printed"]).all())),
              f"The printed counts do not follow from load nodes every 20 ms; the program here has {load_nodes()}."),
    ]  # fmt: skip


def _times(table: pd.DataFrame, name: str, key: str, why: str) -> Claim:
    """Return the times beside the printed ones; what Newton's method solves in one step tells nothing of a program."""
    iterated = table[table[f"iterations_{key}"] > 1]
    ratio = iterated["solve_s_printed"] / iterated[f"solve_s_{key}"]
    faster = int((ratio >= 1.0).sum())
    single = ", ".join(table.loc[table[f"iterations_{key}"] <= 1, "case"])
    text = f"solve time of the paper / ours, {name}"
    ours = f"{ratio.min():.3g} to {ratio.max():.3g}, faster in {faster} of {len(ratio)}"
    ours += f"; {single} not counted: one step of Newton's method" if single else ""
    holds = faster == len(ratio)
    return Claim(text, "1", ours, verdict(holds=holds, partly=faster > 0), "" if holds else why)
