"""What is said of a study file, or of arguments, that are refused, and the grid of a file that is
right."""

from collections.abc import Callable
from typing import Any

import pytest

from disc_model import ParameterError
from disc_model.studies.grid import GridStudy
from disc_model.studies.study import StudyError, parse_study


def faults_of(parse: Callable[..., object], *arguments: Any, **named: Any) -> list[str]:
    """All faults that come in the one error."""
    with pytest.raises((StudyError, ParameterError)) as error:
        parse(*arguments, **named)
    return list(error.value.faults)


def parse_grid(raw: Any) -> GridStudy:
    """The grid that a file's content says."""
    grid = parse_study(raw).grid
    assert grid is not None
    return grid
