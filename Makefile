# `make reproduce` is all a reader needs; the other targets are for work on the project.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# A lock lists everything, so pip is to look for nothing else: it would try newer releases of a package wanted with extras.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps
CORES ?= 2
# What jobs print at the same time comes in one piece each, where make knows how to.
SYNC := $(if $(filter output-sync,$(.FEATURES)),--output-sync=target)

# The quick tests in parts that cores share, the longest first. Ramps and another law of contact have kernels of their
# own: what needs them is in one part, so that they are compiled once.
PARTS := test-figures test-others test-stability test-validation test-engine test-studies
TESTED_figures := tests/figures
TESTED_validation := tests/validation tests/simulation
TESTED_stability := tests/stability
TESTED_engine := tests/engine tests/benchmarks tests/analysis
TESTED_studies := tests/studies
TESTED_others := tests/paper tests/data tests/disc tests/docs tests/packaging $(wildcard tests/test_*.py)

.PHONY: measurements compile-times schema report explore orthonormal survival gallery docs linkcheck env reproduce test test-parts $(PARTS) test-portable test-long coverage test-study lint format bench bench-pages lock clean

env: $(STAMP)

# Every version is locked and every file checked by its hash; the package itself is installed in place.
$(STAMP): requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	@echo "Installing into $(VENV), which takes a minute or two"
	$(INSTALL) --require-hashes -r requirements.lock
	$(INSTALL) --no-build-isolation -e .
	touch $@

reproduce: env
	$(BIN)/snakemake -j$(CORES)

# One HTML file with every figure, the ledger and the provenance, from results that are there.
report: env
	$(BIN)/snakemake --report results/paper/report.html all $(wildcard results/paper/normalisation.html results/paper/survival.html)

# One HTML page to look at every grid point and at motions: results/paper/explorer.html; or, with STUDY=my_study.yaml, that
# of another study.
explore: env
	$(BIN)/snakemake -j$(CORES) explorer $(if $(STUDY),--configfile $(STUDY))

# The paper's cases with modes normalised as Eq. (17) says, and what that changes.
orthonormal: reproduce
	$(BIN)/snakemake -j$(CORES) --configfile config/paper.yaml config/paper_orthonormal.yaml
	$(BIN)/snakemake -j$(CORES) results/paper/normalisation.html

# What survives of the paper's conclusions under other models of disc and contact: some minutes, mostly to compile.
survival: env
	$(BIN)/snakemake -j$(CORES) --configfile config/survival.yaml
	$(BIN)/snakemake -j$(CORES) results/paper/survival.html

# Comparisons with measurements: the tables behind docs/measurements.md.
measurements: env
	$(BIN)/python -m docs.measurements.report

# The small pictures of docs/ and of the README, from finished figures.
gallery: env
	$(BIN)/python -m docs.make_gallery

$(VENV)/.docs: requirements-docs.lock $(STAMP)
	$(INSTALL) --require-hashes -r requirements-docs.lock
	touch $@

# The pages of docs/ and the reference as a site, in docs/_build/html; a warning, as of a link that leads nowhere, ends it.
docs: $(VENV)/.docs
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html
	@echo "The site begins at docs/_build/html/index.html"

# Links to the outside, which need the network.
linkcheck: $(VENV)/.docs
	$(BIN)/sphinx-build -q -W --keep-going -b linkcheck docs docs/_build/linkcheck

# What editors check study files by, from the models that check them.
schema: env
	$(BIN)/python workflow/schemas/write_schema.py > workflow/schemas/study.schema.json

# All quick tests; each part says what it found when it is done.
test: env
	$(MAKE) --jobs=$(CORES) --keep-going $(SYNC) test-parts

test-parts: $(PARTS)

$(PARTS): test-%: env
	$(BIN)/pytest -m "not slow and not workflow" $(TESTED_$*)

# What compiling each kind of kernel costs, from an empty cache.
compile-times: env
	$(BIN)/python workflow/scripts/measure_compilation.py

# The numbers once more, in the instructions that every processor has: no fused multiplication and addition, short vectors.
# What compiles kernels of its own is left to `make test-long`, which tries all in every set of instructions; how kernels are
# kept in files does not depend on instructions.
test-portable: env
	NUMBA_CACHE_DIR=$(CURDIR)/$(VENV)/kernels-generic $(BIN)/python -m tests.instruction_sets generic \
	  $(BIN)/pytest -m "not slow and not workflow" tests/engine tests/disc/test_plate.py tests/validation \
	  --ignore tests/validation/test_contact_laws.py --ignore tests/validation/test_ramps.py --ignore tests/engine/jit

# With the rival integrators, so that their tests are not passed over. The random search draws thirty times as many inputs
# as the quick tests; SEED=..., as the command shows it, draws the same ones again.
SEED := $(shell od -An -N4 -tu4 /dev/urandom | tr -d ' ')
test-long: $(VENV)/.bench
	$(BIN)/pytest --hypothesis-profile=long --hypothesis-seed=$(SEED)

# Lines and branches of everything. Compiled kernels are not seen, so that the engine's own tests run once more without
# compilation; there they are Python, a thousand times slower, and tests marked `compiled` are left out.
coverage: $(VENV)/.bench
	$(BIN)/pytest -m "not slow and not workflow" --cov --cov-report=
	NUMBA_DISABLE_JIT=1 $(BIN)/pytest -m "not slow and not workflow and not compiled" tests/engine tests/validation \
	  tests/stability/test_return_map.py tests/benchmarks/test_methods.py \
	  --cov --cov-append --cov-fail-under=97 --durations=5

# The whole pipeline on a study of a few seconds.
test-study: env
	$(BIN)/snakemake -j$(CORES) --configfile config/test.yaml

lint: env
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/snakefmt --check Snakefile workflow benchmarks
	$(BIN)/snakemake --lint

format: env
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(BIN)/snakefmt Snakefile workflow benchmarks

$(VENV)/.bench: requirements-bench.lock $(STAMP)
	$(INSTALL) --require-hashes -r requirements-bench.lock
	touch $@

# Speed against accuracy, where methods fail, what answers cost: measured here and now, on one core at a time.
bench: $(VENV)/.bench
	$(BIN)/snakemake -j1 bench

# What README and docs say about speed, from that run.
bench-pages: env
	$(BIN)/python -m benchmarks.pages results/bench/work_precision.csv README.md docs/benchmark.md

# One version of each package for every system and every Python that the project supports.
LOCK := $(BIN)/uv pip compile --quiet --upgrade --universal --fork-strategy fewest --python-version 3.11 \
  --generate-hashes --no-emit-index-url --no-emit-find-links --no-header
lock: env
	$(LOCK) --output-file requirements.lock requirements.in
	$(LOCK) --output-file requirements-bench.lock requirements-bench.in
	$(LOCK) --output-file requirements-docs.lock requirements-docs.in

# Results stay, and so does .snakemake, the record of how they were made.
clean:
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .benchmarks build dist docs/_build
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
