# Everything a contributor runs. Needs Python 3.11 to 3.13 and make; nothing else has to be installed first.

VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.quadlab-installed

# The interpreter that makes the virtual environment; override with `make setup PYTHON=/path/to/python`.
PYTHON ?= $(shell for candidate in python3.11 python3.12 python3.13 python3; do \
	$$candidate -c "$(CHECK_VERSION)" 2>/dev/null && echo $$candidate && break; done)
CHECK_VERSION := import sys, venv; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))

# Small matrices: more BLAS threads only get into each other's way.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

PYTEST_ARGS ?= -n auto
TAG ?= demo

.PHONY: setup system test lint format demo acceptance bench reproduce compare figures lock wheel clean

## Install the locked packages and quadlab itself; does nothing if that was done.
setup: $(STAMP)

$(STAMP): pyproject.toml .ci/constraints.txt
	@"$(or $(PYTHON),false)" -c "$(CHECK_VERSION)" 2>/dev/null || \
		{ echo "quadlab needs Python 3.11, 3.12 or 3.13; found '$(PYTHON)'. Use: make setup PYTHON=/path/to/python3.11" >&2; exit 1; }
	@test -x $(BIN)/python || "$(PYTHON)" -m venv $(VENV)
	@echo "installing the locked packages into $(VENV) (about 2.4 GB on disk)"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -c .ci/constraints.txt -e ".[dev,video]"
	@touch $@

## Rendering without a display needs three system libraries; installs them where it may, says how otherwise.
system:
	@sh .ci/rendering_libraries

## Run the tests.
test: setup system
	$(BIN)/python -m pytest $(PYTEST_ARGS)

## Check style, formatting and types.
lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

## Mend style and formatting.
format: setup
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

## ANYmal trots over an unseen plank and is pushed: log, figures and video in results/demo/.
demo: setup system
	$(BIN)/python experiments/demo.py --tag $(TAG)

## Run every acceptance trial: the table in results/acceptance/ says how each ended.
acceptance: setup
	$(BIN)/python experiments/run_study.py acceptance

## Measure planning and control time on this machine.
bench: setup
	$(BIN)/python experiments/bench.py
	$(BIN)/python experiments/bench_planners.py
	$(BIN)/python experiments/bench_kinematic_sqp.py
	$(BIN)/python experiments/bench_controllers.py
	$(BIN)/python experiments/bench_controllers.py --closed-loop
	$(BIN)/python experiments/bench_loop.py
	$(BIN)/python experiments/bench_sweep.py --many 0

## Run every experiment of the papers that was not run yet, and redraw their tables and figures.
reproduce: setup system
	$(BIN)/python experiments/reproduce.py paper=all

## Compare planners and controllers on a few cases; the whole comparison: experiments/run_study.py comparison.
compare: setup
	$(BIN)/python experiments/run_study.py comparison_small

## Redraw the tables and figures of the papers from results/, without running anything.
figures: setup
	$(BIN)/python -m paper_figures

## Resolve all dependencies anew; commits uv.lock and .ci/constraints.txt together.
lock:
	sh .ci/lock

## Build the wheel and the source archive.
wheel: setup
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .

## Remove what tools leave behind; keeps the virtual environment and results.
clean:
	rm -rf dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -path ./$(VENV) -prune -o -name __pycache__ -type d -exec rm -rf {} +
