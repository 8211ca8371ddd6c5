"""Run studies, conf/study/<name>.yaml, into results/<name>/: python experiments/run_study.py acceptance [--jobs 2].

What was done before is not run again. Exit code 1 if a job ended in an error of the program, 2 if something in a study
is wrong, in which case nothing was run; falls are rows.
"""

import sys

from quadlab.studies.main import main

if __name__ == "__main__":
    sys.exit(main())
