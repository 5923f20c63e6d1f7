"""What a refusal of bad input has to say."""

import pytest

from disc_model.errors import ParameterError


def refusal(message: str) -> pytest.RaisesExc[ParameterError]:
    """A context that passes if what it holds is refused with a message that matches a pattern."""
    return pytest.raises(ParameterError, match=message)
