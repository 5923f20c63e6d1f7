"""Results of which Snakemake has no record; and a Snakemake that keeps its records in another way."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from snakemake.persistence.file import FilePersistence
from snakemake.settings.enums import PersistenceBackend

from disc_model.data.provenance import unrecorded, why_unknown


def test_results_without_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = {"recorded": "YQ==", "cut": "Yg==", "unfinished": "Yw==", "absent": "ZA=="}  # a, b, c, d
    for folder in ("metadata", "incomplete"):
        Path(".snakemake", folder).mkdir(parents=True)
    Path(".snakemake/metadata", names["recorded"]).write_text('{"rule": "r"}')
    Path(".snakemake/metadata", names["cut"]).write_text('{"ru')
    Path(".snakemake/incomplete", names["unfinished"]).write_text("{}")
    for file in ("a", "b", "c", "e"):
        Path(file).touch()
    assert unrecorded(["a", "b", "c", "d", "e"]) == ["b", "e"]


def workflow(backend: PersistenceBackend = PersistenceBackend.FILE) -> SimpleNamespace:
    return SimpleNamespace(workflow_settings=SimpleNamespace(persistence_backend=backend))


def test_this_snakemake_is_known() -> None:
    assert why_unknown(workflow()) == ""


def test_a_database_is_not_looked_into() -> None:
    assert why_unknown(workflow(PersistenceBackend.DB)) == "they are in a database"


@pytest.mark.parametrize("module", ["snakemake.persistence.file", "snakemake.settings.enums"])
def test_a_module_that_is_gone(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    assert module in why_unknown(workflow())


def test_a_function_that_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(FilePersistence, "_record_path")
    assert "_record_path" in why_unknown(workflow())


def test_a_setting_that_is_gone() -> None:
    assert "workflow_settings" in why_unknown(SimpleNamespace())


def test_other_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FilePersistence, "_record_path", lambda self, folder, name: f"{folder}/{name}")
    assert why_unknown(workflow()) == "one is called metadata/results/paper/cases/F02.nc"
