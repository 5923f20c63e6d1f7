"""Study files: what a YAML file under config/ may say, checked all at once, and the cases it expands to.

A study of named cases has a name, base values, things to record by default, and the cases; each case inherits
the base and may override any of it. `load_study` reads such a file, `parse_study` takes the mapping itself;
both raise one `StudyError` that lists every fault with its path.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, StringConstraints, ValidationError, model_validator

from disc_model.case import CaseSpec
from disc_model.errors import DiscModelError, ParameterError
from disc_model.parameters import Parameters, Real
from disc_model.record import Poincare, Window
from disc_model.variables import SCALARS

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]
M = TypeVar("M", bound=BaseModel)
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""
TAKEN_WINDOWS = TAKEN | {"events", "poincare"}


class StudyError(DiscModelError, ValueError):
    """A study file that breaks rules; lists every fault as ``path = value: rule``."""

    def __init__(self, *faults: str, source: str = "study") -> None:
        self.faults = faults
        self.source = source
        count = f"{len(faults)} fault{'s' if len(faults) > 1 else ''}"
        super().__init__("\n  ".join([f"{source}: {count}", *faults]))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuild_error, (self.faults, self.source))


def _rebuild_error(faults: tuple[str, ...], source: str) -> StudyError:
    return StudyError(*faults, source=source)


class _Strict(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Span(_Strict):
    """A stretch of time: ``{start, stop}`` in s, or ``{last: s}`` counted back from the end of the run.

    The last 20 s of a shorter run are all of it.
    """

    start: Annotated[Real, Field(ge=0, allow_inf_nan=False)] | None = None
    stop: Annotated[Real, Field(gt=0, allow_inf_nan=False)] | None = None
    last: Annotated[Real, Field(gt=0, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.last is not None and (self.start is not None or self.stop is not None):
            raise ValueError("must give either last, or start and stop")
        return self

    def resolve(self, t_end: float) -> tuple[float, float]:
        """Start and stop in s; raises ValueError if they do not lie within [0, t_end] in this order."""
        stop = t_end if self.stop is None else self.stop
        start = (self.start or 0.0) if self.last is None else max(t_end - self.last, 0.0)
        if not 0 <= start < stop <= t_end:
            raise ValueError(f"must be within the run: 0 <= start={start:g} < stop={stop:g} <= t_end={t_end:g}")
        return start, stop


class WindowSpec(Span):
    """Uniform samples over a span; see `disc_model.Window` for `rate`, `theta` and `envelope`."""

    rate: Annotated[Real, Field(gt=0, allow_inf_nan=False)]
    theta: Real = 1.0
    envelope: Annotated[int, Field(ge=2)] | None = None

    def window(self, t_end: float) -> Window:
        """The window; an envelope leaves out the instant `stop`, which would be a bin of its own."""
        start, stop = self.resolve(t_end)
        if self.envelope is not None:
            stop = max(stop - 0.5 / self.rate, start + 0.25 / self.rate)
        return Window(start=start, stop=stop, rate=self.rate, theta=self.theta, envelope=self.envelope)


class RecordSpec(_Strict):
    """What a case keeps. Windows bear names, under which figures and claims find them."""

    windows: dict[Name, WindowSpec] = {}
    poincare: Poincare | None = None
    events: bool | Span = True
    energy: bool = False


class Case(_Strict):
    """One named simulation of a study."""

    title: str
    reference: str = ""
    parameters: dict[str, Any] = {}
    t_end: Annotated[Real, Field(gt=0, allow_inf_nan=False)]
    tol: Annotated[Real, Field(ge=1e-15, le=1e-2)] = 1e-10
    stop_at: Literal["first_separation"] | None = None
    record: RecordSpec = RecordSpec()


class _Header(_Strict):
    """The parts of a study file that are not cases. `cases` is checked case by case."""

    study: Name
    title: str = ""
    base: dict[str, Any] = {}
    tol: Any = 1e-10
    record: dict[str, Any] = {}
    cases: Annotated[dict[str, Any], Field(min_length=1)]
    figures: tuple[str, ...] = ()


@dataclass(frozen=True)
class Study:
    """A checked study file. `cases` and `specs` have the same keys, in the order of the file."""

    name: str
    title: str
    cases: Mapping[str, Case]
    specs: Mapping[str, CaseSpec]
    figures: tuple[str, ...]

    @property
    def labels(self) -> dict[str, dict[str, str]]:
        """What is written about the cases and does not change their results."""
        return {name: {"title": case.title, "reference": case.reference} for name, case in self.cases.items()}


def load_study(path: str | Path) -> Study:
    """Read and check a study file.

    Raises
    ------
    StudyError
        Listing every fault: wrong YAML, keys given twice, unknown keys, values that break a rule.
    """
    raw, faults = _read(Path(path))
    return _with_more_faults(raw, faults, str(path))


def study_from_config(config: Any, files: Iterable[str | Path]) -> Study:
    """The study that Snakemake read from files, later ones over earlier ones, and its command line.

    Raises
    ------
    StudyError
        As `load_study`; keys given twice are looked for in the files, since the mapping no longer shows them.
    """
    paths = [Path(file) for file in files]
    faults = [fault for path in paths for fault in _read(path)[1]]
    return _with_more_faults(config, faults, ", ".join(map(_shown_path, paths)))


def parse_study(raw: Any) -> Study:
    """Check the mapping a study file holds; raises `StudyError` listing every fault."""
    faults = _Faults()
    header = _validated(_Header, raw, (), faults)
    raw = raw if isinstance(raw, Mapping) else {}
    cases: dict[str, Case] = {}
    specs: dict[str, CaseSpec] = {}
    for name, own in _mapping(raw.get("cases")).items():
        case, spec = _parse_case(raw, str(name), own, faults)
        if case is not None and spec is not None:
            cases[str(name)], specs[str(name)] = case, spec
    _check_figures(raw, specs, faults)
    if faults or header is None:
        raise StudyError(*faults)
    return Study(header.study, header.title, cases, specs, header.figures)


# ----------------------------------------------------------------------------------------------------
# One case


def _parse_case(raw: Mapping[str, Any], name: str, own: Any, faults: _Faults) -> tuple[Case | None, CaseSpec | None]:
    path = ("cases", name)
    if not _is_name(name):
        faults.add(path, "", "a case's name must be letters, digits and _, starting with a letter")
    if name in TAKEN:
        faults.add(path, "", "a case must not be called so, the name is taken by a variable")
    if not isinstance(own, Mapping):
        faults.add(path, own, "must be a mapping")
        return None, None
    said = {"parameters": raw.get("base"), "record": raw.get("record"), "tol": raw.get("tol")}
    inherited = {key: value for key, value in said.items() if value is not None}
    whole = _inherit(inherited, own)
    place = _Origin(path, own, inherited)
    case = _validated(Case, whole, path, faults, place)
    parameters = _parse_parameters(whole.get("parameters", {}), place, faults)
    if case is None:
        return None, None
    windows = _resolve_windows(case, place, faults)
    events = _resolve_events(case, place, faults)
    if parameters is None or windows is None:
        return case, None
    spec = CaseSpec(
        parameters,
        case.t_end,
        case.tol,
        case.stop_at,
        windows,
        case.record.poincare,
        events,
        case.record.energy,
    )
    return case, spec


def _parse_parameters(values: Any, place: _Origin, faults: _Faults) -> Parameters | None:
    if not isinstance(values, Mapping):
        return None  # already reported by the schema
    try:
        return Parameters.model_validate(values)
    except ParameterError as error:
        for fault in error.faults:
            name = fault.partition("=")[0].partition(":")[0]
            rest = fault.removeprefix(name)
            if rest.startswith("="):
                rest = f" = {rest[1:]}"
            faults.add_text(f"{_dotted(place.of(('parameters', name)))}{rest}")
        return None


def _resolve_windows(case: Case, place: _Origin, faults: _Faults) -> tuple[tuple[str, Window], ...] | None:
    windows = []
    for name, spec in case.record.windows.items():
        path = place.of(("record", "windows", name))
        if name in TAKEN_WINDOWS:
            faults.add(path, "", "a window must not be called so, the name is taken by a variable or group")
        try:
            windows.append((name, spec.window(case.t_end)))
        except ValueError as error:
            faults.add(path, "", str(error))
    return tuple(windows) if len(windows) == len(case.record.windows) else None


def _resolve_events(case: Case, place: _Origin, faults: _Faults) -> tuple[float, float] | None:
    if isinstance(case.record.events, bool):
        return (0.0, case.t_end) if case.record.events else None
    try:
        return case.record.events.resolve(case.t_end)
    except ValueError as error:
        faults.add(place.of(("record", "events")), "", str(error))
        return None


def _check_figures(raw: Mapping[str, Any], specs: Mapping[str, CaseSpec], faults: _Faults) -> None:
    """Figures must exist and find their cases and windows in the study."""
    from disc_model.figures.catalogue import CATALOGUE

    listed = raw.get("figures") or ()
    if isinstance(listed, str) or not isinstance(listed, Iterable):
        return
    known = set(_mapping(raw.get("cases")))
    for i, name in enumerate(listed):
        path = ("figures", str(i))
        if name not in CATALOGUE:
            faults.add(path, name, f"unknown figure (known: {', '.join(CATALOGUE)})")
            continue
        for case, windows in CATALOGUE[name].needs.items():
            if case not in known:
                faults.add(path, name, f"needs a case {case}")
            elif case in specs:
                missing = [window for window in windows if window not in dict(specs[case].windows)]
                for window in missing:
                    faults.add(path, name, f"needs a window {window} in cases.{case}.record.windows")


# ----------------------------------------------------------------------------------------------------
# Faults and where they come from


class _Faults(list[str]):
    """Faults in the order found; what several cases inherit is listed once."""

    def add(self, path: tuple[str, ...], value: Any, rule: str) -> None:
        shown = "" if value == "" else f" = {value!r}"
        self.add_text(f"{_dotted(path)}{shown}: {rule}")

    def add_text(self, text: str) -> None:
        if text not in self:
            self.append(text)


@dataclass(frozen=True)
class _Origin:
    """Tells for a place in an expanded case where the file says it: in the case, or in what it inherits."""

    path: tuple[str, ...]
    own: Mapping[str, Any]
    inherited: Mapping[str, Any]

    def of(self, place: tuple[str, ...]) -> tuple[str, ...]:
        if _depth(self.own, place) >= _depth(self.inherited, place):
            return (*self.path, *place)
        return ("base" if place[0] == "parameters" else place[0], *place[1:])


def _depth(mapping: Any, place: tuple[str, ...]) -> int:
    """How many steps of the way to a place lead through mappings that say something."""
    if not place or not isinstance(mapping, Mapping) or place[0] not in mapping:
        return 0
    return 1 + _depth(mapping[place[0]], place[1:])


def _validated(
    model: type[M], raw: Any, path: tuple[str, ...], faults: _Faults, place: _Origin | None = None
) -> M | None:
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        _add_pydantic(error, path, faults, place)
        return None


def _add_pydantic(error: ValidationError, path: tuple[str, ...], faults: _Faults, place: _Origin | None = None) -> None:
    for item in error.errors(include_url=False):
        loc = tuple(str(step) for step in item["loc"] if step not in ("bool", "Span", "[key]"))
        where = place.of(loc) if place and loc else (*path, *loc)
        kind = item["type"]
        if kind == "missing":
            faults.add(where, "", "is required")
        elif kind == "extra_forbidden":
            faults.add(where, item["input"], "unknown key")
        else:
            value = item["input"] if not isinstance(item["input"], Mapping) else ""
            faults.add(where, value, _rule(item["msg"]))


def _rule(message: str) -> str:
    for old, new in (
        ("Value error, ", ""),
        ("Input should be", "must be"),
        ("greater than or equal to", ">="),
    ):
        message = message.replace(old, new)
    return message.replace("less than or equal to", "<=").replace("greater than", ">").replace("less than", "<")


def _dotted(path: tuple[str, ...]) -> str:
    return ".".join(path) if path else "study"


# ----------------------------------------------------------------------------------------------------
# Plain helpers


def _with_more_faults(raw: Any, more: list[str], source: str) -> Study:
    """`parse_study`, with faults found already and the name of the file in the error."""
    try:
        study = parse_study(raw)
    except StudyError as error:
        raise StudyError(*more, *error.faults, source=source) from None
    if more:
        raise StudyError(*more, source=source)
    return study


def _read(path: Path) -> tuple[Any, list[str]]:
    try:
        return read_yaml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise StudyError(f"cannot be read: {error.strerror}", source=str(path)) from None
    except StudyError as error:
        raise StudyError(*error.faults, source=str(path)) from None


def _shown_path(path: Path) -> str:
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)


def _is_name(text: str) -> bool:
    return text.isascii() and text.replace("_", "a").isalnum() and text[:1].isalpha()


def _mapping(value: Any) -> Mapping[Any, Any]:
    return value if isinstance(value, Mapping) else {}


def _inherit(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """`own` over `base`, mappings merged key by key; None drops what is inherited."""
    merged = dict(base)
    for key, value in own.items():
        if value is None and key in base:
            del merged[key]
            continue
        old = merged.get(key)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            merged[key] = _inherit(old, value)
        else:
            merged[key] = value
    return merged


class _UniqueKeyLoader(yaml.SafeLoader):
    """Remembers keys given twice instead of silently taking the last."""

    def __init__(self, stream: Any) -> None:
        super().__init__(stream)
        self.faults: list[str] = []

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        first: dict[Any, int] = {}
        for key_node, _ in node.value:
            key = key_node.value
            line = key_node.start_mark.line + 1
            if key in first and key != "<<":
                self.faults.append(f"{key}: given twice, in lines {first[key]} and {line}")
            first.setdefault(key, line)
        return super().construct_mapping(node, deep)


def read_yaml(text: str) -> tuple[Any, list[str]]:
    """A YAML document and the keys that it gives twice.

    Raises
    ------
    StudyError
        If the text is no YAML.
    """
    loader = _UniqueKeyLoader(text)
    try:
        return loader.get_single_data(), loader.faults
    except yaml.YAMLError as error:
        raise StudyError(" ".join(str(error).split())) from None
    finally:
        loader.dispose()
