"""From nothing to every table and figure: runs the studies that are missing, draws, and says what became of it."""

import sys
from collections.abc import Sequence
from pathlib import Path

from pydantic import Field, ValidationError, field_validator

from paper_figures.drawing import drawings
from paper_figures.gallery import PAPERS as TITLES
from paper_figures.gallery import ArtefactScript, artefact_scripts, is_drawn
from paper_figures.readme_table import write_readme
from paper_figures.report_page import write_page
from paper_figures.summary import Judged, judge, write_summary
from quadlab.analysis.study_results import StudyResults
from quadlab.command_line import EXIT_FAILED, EXIT_OK, exit_code
from quadlab.configuration import StrictModel
from quadlab.errors import ConfigurationError
from quadlab.studies.main import INTERRUPTED
from quadlab.studies.progress import StudyProgress
from quadlab.studies.runner import run_studies
from quadlab.sweeps.limits import usable_cores
from quadlab.trials.problems import suggestion, validation_problems

PAPERS = ("gehring2017", "winkler2017", "bellicoso2016")
FOLDER = Path(__file__).parent
USAGE = """usage: python experiments/reproduce.py [paper=all] [artefact=...] [jobs=...]

  paper     gehring2017, winkler2017, bellicoso2016, all of them, or another folder such as comparison
  artefact  part of the name of a script in paper_figures/<paper>/; all of the paper if it is left out
  jobs      processes at a time; one a core if it is left out
"""


class ReproduceOptions(StrictModel):
    """What to reproduce.

    Attributes:
        paper: one of them, all three, or another folder that has a title.
        artefact: part of the name of a script; empty for all of the paper.
        jobs: processes at a time.
    """

    paper: str = "all"
    artefact: str = ""
    jobs: int = Field(default_factory=usable_cores, ge=1)

    @field_validator("paper")
    @classmethod
    def _is_known(cls, paper: str) -> str:
        if paper not in ("all", *TITLES):
            raise ValueError(f"unknown; {suggestion(paper, ('all', *TITLES))}")
        return paper


def main(arguments: Sequence[str]) -> int:
    """Reproduce what arguments such as ``paper=all`` ask for and return the exit code."""
    if {"-h", "--help"} & set(arguments):
        sys.stdout.write(USAGE)
        return 0
    return exit_code(lambda: reproduce(read_options(arguments), StudyProgress()), INTERRUPTED)


def read_options(arguments: Sequence[str]) -> ReproduceOptions:
    """Return the options that ``key=value`` arguments stand for.

    Raises:
        ConfigurationError: with one line for each mistake.
    """
    pairs = [argument.partition("=") for argument in arguments]
    wrong = [key for key, equals, _ in pairs if not equals]
    if wrong:
        keys = ", ".join(f"{key}=..." for key in ReproduceOptions.model_fields)
        raise ConfigurationError(f"'{wrong[0]}': expected key=value; known: {keys}")
    try:
        return ReproduceOptions.model_validate({key: value for key, _, value in pairs})
    except ValidationError as error:
        raise ConfigurationError("\n".join(validation_problems(ReproduceOptions, error))) from error


def reproduce(options: ReproduceOptions, progress: StudyProgress) -> int:
    """Run what is missing, draw, print the table of artefacts and return the exit code.

    Raises:
        ConfigurationError: if no artefact has that name, or a study is wrong.
    """
    scripts = chosen_scripts(options)
    results = StudyResults(FOLDER.parent / "results")
    studies = list(dict.fromkeys(study for script in scripts for study in script.artefact.studies))
    errors = run_studies(studies, results.folder, options.jobs, progress)
    missing = draw_all(scripts, results, options.jobs, progress)
    judged = judge(artefact_scripts([]), results)
    write_overviews(judged, results)
    for entry in [entry for entry in judged if entry.script in scripts]:
        progress.say(f"{entry.script.artefact.source:28s} {entry.verdict:15s} {entry.script.artefact.title}")
        for claim in entry.claims:
            progress.say(f"    {claim.verdict.value:15s} {claim.text}: {claim.ours} (paper: {claim.paper})")
    return EXIT_FAILED if errors or missing else EXIT_OK


def chosen_scripts(options: ReproduceOptions) -> list[ArtefactScript]:
    """Return the scripts that the options ask for.

    Raises:
        ConfigurationError: if there are none.
    """
    papers = PAPERS if options.paper == "all" else (options.paper,)
    scripts = [script for script in artefact_scripts([]) if script.paper in papers]
    chosen = [script for script in scripts if options.artefact in script.name]
    if not chosen:
        names = {script.name for script in scripts}
        raise ConfigurationError(f"artefact: unknown '{options.artefact}'; {suggestion(options.artefact, names)}")
    return chosen


def write_overviews(judged: Sequence[Judged], results: StudyResults) -> list[Path]:
    """Write what tells of all artefacts together: table of claims, page, and the table in the README."""
    page = write_page(judged, results, FOLDER)
    readme = write_readme(FOLDER.parent / "README.md", judged)
    return [*write_summary(judged, results.folder), page, readme]


def draw_all(scripts: Sequence[ArtefactScript], results: StudyResults, workers: int, progress: StudyProgress) -> int:
    """Draw what can be drawn and is not up to date, some at a time, and return how many artefacts were not drawn.

    Args:
        scripts: of the artefacts.
        results: that they are drawn from.
        workers: processes at a time.
        progress: told what was written, and what could not be.
    """
    missing = 0
    waiting = [script for script in scripts if not is_drawn(script, results, FOLDER)]
    for drawing in drawings(waiting, results, FOLDER, workers):
        for path in drawing.paths:
            progress.say(str(path.relative_to(FOLDER.parent)))
        if drawing.problem:
            missing += 1
            progress.say(f"{drawing.script.name}: {drawing.problem}")
    return missing
