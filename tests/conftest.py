"""What all tests share."""

import gc
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

# The quick suite draws the same values in every clone. `make nightly` searches at random, by a
# seed that it prints.
settings.register_profile(
    "quick",
    max_examples=100,
    derandomize=True,
    database=None,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
settings.register_profile(
    "long", settings.get_profile("quick"), max_examples=3000, derandomize=False
)
settings.load_profile("quick")
# Hypothesis also draws constants of the modules that are loaded. A test by itself would draw other
# values.
providers._get_local_constants = lambda: providers._local_constants
IMPORT = re.compile(r"^\s*(?:from|import) (disc_model[\w.]*)(?: import (\([^)]*\)|.*))?", re.M)
ALLOCATIONS = 20_000  # after which garbage is looked for: closed figures are thousands of objects


def pytest_sessionstart() -> None:
    """End where tests import a private name, or a module below the package's second level."""
    wrong = []
    for path in Path(__file__).parent.rglob("*.py"):
        for module, names in IMPORT.findall(path.read_text(encoding="utf-8")):
            if module.count(".") > 2 or re.search(r"\b_[a-z]", f"{module} {names}"):
                wrong.append(f"{path}: {module}")
    if wrong:
        pytest.exit("tests use public names only:\n" + "\n".join(sorted(wrong)), returncode=1)


def pytest_collection_finish() -> None:
    """Let the search for garbage pass over what has been imported, which stays until the end."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(ALLOCATIONS)


@pytest.fixture
def seed(request: pytest.FixtureRequest) -> int:
    """Of a random search: that of the command line, or another each time; a test that fails shows
    it."""
    found = request.config.getoption("--hypothesis-seed")
    if found is None:
        chosen = np.random.SeedSequence().entropy % 2**32
    else:
        chosen = int(found)
    print(f"drawn by --hypothesis-seed={chosen}")
    return chosen
