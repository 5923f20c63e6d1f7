"""YAML that is refused."""

from __future__ import annotations

import pytest

from disc_model.studies.files import read_yaml
from tests.studies.refused import faults_of


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("&a [*a]", "a value contains itself"),
        ("a: &a [" + "1, " * 500 + "]\nb: &b [" + "*a, " * 500 + "]", "more than 100000 values"),
        ("a: !!timestamp x", "a value does not fit its tag"),
        ("a: [", "line 1, column 5: while parsing a flow node"),
        ("a: 1\nb: 2\n c: 3", "line 3, column 3: mapping values are not allowed here"),
    ],
)
def test_yaml_that_is_refused(text: str, fault: str) -> None:
    assert fault in "\n".join(faults_of(read_yaml, text))


def test_no_document_is_nothing() -> None:
    assert read_yaml("") == (None, [])
