# `make reproduce` is all a reader needs; CONTRIBUTING.md shows the commands that have no target here.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# A lock lists everything, so pip is to look for nothing else: it would try newer releases of a package wanted with extras.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps
CORES ?= 2
# One file of tests stays in one process, which makes its fixtures once.
PYTEST := $(BIN)/pytest --numprocesses=$(CORES) --dist=loadfile

.PHONY: env reproduce test study lint docs nightly smoke coverage lock clean

env: $(STAMP)

# Every version is locked and every file checked by its hash; the package itself is installed in place.
$(STAMP): requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	@echo "Installing into $(VENV), which takes a minute or two"
	$(INSTALL) --require-hashes -r requirements.lock
	$(INSTALL) --no-build-isolation -e .
	touch $@

# Rivals and references of other libraries; what builds the site.
$(VENV)/.bench $(VENV)/.docs: $(VENV)/.%: requirements-%.lock $(STAMP)
	$(INSTALL) --require-hashes -r requirements-$*.lock
	touch $@

reproduce: env
	$(BIN)/snakemake -j$(CORES)

# All quick tests.
test: env
	$(PYTEST)

# The whole workflow on a study of a few seconds.
study: env
	$(BIN)/snakemake -j$(CORES) --configfile config/test.yaml

lint: env
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/snakefmt --check Snakefile workflow benchmarks
	$(BIN)/snakemake --lint

# The pages of docs/ with their notebooks as a site; a warning, as of a link that leads nowhere, ends it.
docs: $(VENV)/.docs
	$(BIN)/sphinx-build -q -W --keep-going -b html docs docs/_build/html
	@echo "The site begins at docs/_build/html/index.html"

# What no single change waits for: all tests, among them those in a browser, of other instruction sets and of the
# installed package; random inputs thirty times as many, drawn by a seed that is shown; coverage; the site; other Pythons.
SEED := $(shell od -An -N4 -tu4 /dev/urandom | tr -d ' ')
OTHERS ?= 3.12 3.13
nightly: $(VENV)/.bench
	$(PYTEST) -m "" --hypothesis-profile=long --hypothesis-seed=$(SEED)
	$(MAKE) coverage docs
	for version in $(OTHERS); do $(MAKE) smoke PYTHON=python$$version VENV=.venv-$$version || exit 1; done

# What another Python has to pass.
smoke: env
	$(PYTEST) tests/engine tests/validation
	$(BIN)/snakemake -j$(CORES) --forceall --configfile config/test.yaml

# Lines that quick tests run. Compiled kernels are not seen, so the engine's tests run once more without compilation.
coverage: env
	$(PYTEST) --cov --cov-report=
	NUMBA_DISABLE_JIT=1 $(PYTEST) -m "not slow and not compiled" tests/engine --cov --cov-append --cov-fail-under=90

# One version of each package for every system and every Python that the project supports.
lock: env
	for name in requirements requirements-bench requirements-docs; do \
	  $(BIN)/uv pip compile --quiet --upgrade --universal --fork-strategy fewest --python-version 3.11 --generate-hashes \
	    --no-emit-index-url --no-emit-find-links --no-header --output-file $$name.lock $$name.in || exit 1; \
	done

# Results stay, and so does .snakemake, the record of how they were made.
clean:
	rm -rf $(VENV) .venv-* .pytest_cache .mypy_cache .ruff_cache .import_linter_cache build dist docs/_build
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
