"""What is said of a study file that is refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from disc_model.studies.files import StudyError


def faults_of(parse: Callable[..., object], *arguments: Any) -> list[str]:
    """All faults that come in the one error."""
    with pytest.raises(StudyError) as error:
        parse(*arguments)
    return list(error.value.faults)
