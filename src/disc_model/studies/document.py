"""The model of a study file: `Document`. Rules within one part are checked here, those between parts in `study`."""

import json
import re
from collections.abc import Collection, Mapping
from typing import Annotated, Any, ClassVar, Literal, Union

import pydantic
from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, Tag, WithJsonSchema, create_model

from disc_model.data.variables import BESIDE_WINDOWS, PERTURBATIONS, SCALARS, START, attributes
from disc_model.errors import DiscModelError, Fault, ParameterError, raise_faults
from disc_model.figures.kind import Kind, kind_of, kinds_in
from disc_model.mode_choice import CHOSEN_BY, FREQUENCIES, TRUSTED, ModeRequest, by_frequencies, read_asked
from disc_model.parameters import AUTO, RATIOS, Disc, Parameters
from disc_model.simulation.case import CaseSpec, Poincare, Ramp, SomeParameters, Span, Start, Window, ramp_faults
from disc_model.studies.quantity import Blocks, Range, checked_rule, quantity_names, quantity_of
from disc_model.units import Count, Finite, Positive, Seconds, Strict, Tolerance, must

# ---- Names
STATIC = "static"  # name of the default start
TAKEN = frozenset({"case", "message", "title", "reference", *SCALARS, *Parameters.model_fields})
"""Names of variables in a study's file. Cases and windows become groups beside them and must differ."""


def _but(taken: Collection[str], rule: str) -> AfterValidator:
    return AfterValidator(must(lambda name: name not in taken, rule))


# Snakemake takes a name that repeats itself for an endless recursion
_REPETITION = must(lambda name: not re.search(r"(.+)\1{19}$", name), "must not end in 20 equal parts")
_LETTERS = pydantic.StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=100)
Name = Annotated[str, _LETTERS, AfterValidator(_REPETITION)]
CaseName = Annotated[Name, _but(TAKEN, "must not be the name of a variable")]
WindowName = Annotated[Name, _but(TAKEN | BESIDE_WINDOWS, "must not be the name of a variable or group")]
StartName = Annotated[Name, _but({STATIC}, "is the name of the default start")]

# ---- Values along an axis: lists, linear and logarithmic ranges, and blocks of them
NumberOrUnit = Annotated[Any, WithJsonSchema({"type": ["number", "string"]})]
"""A value as given in the file; its parameter determines its meaning."""


class AxisRange(Range):
    """Evenly spaced values along an axis, and `extra` ones, whose batches leave those of the range unchanged."""

    extra: list[NumberOrUnit] = Field([])

    def blocks(self, resolution: int = 1) -> Blocks:
        return (*super().blocks(resolution), *([tuple(self.extra)] if self.extra else []))


def _axis_kind(raw: Any) -> str | None:
    if isinstance(raw, Mapping):
        return "BlocksOf" if "blocks" in raw else "AxisRange"
    return "a list" if isinstance(raw, list) and raw else None


_NO_AXIS = "must be a list of values, or a range {start, stop, count or step}"
_BY_KIND = pydantic.Discriminator(_axis_kind, custom_error_type="axis", custom_error_message=_NO_AXIS)
Listed = Annotated[list[NumberOrUnit], Field(min_length=1), Tag("a list")]
Block = Annotated[Listed | Annotated[AxisRange, Tag("AxisRange")], _BY_KIND]


class BlocksOf(Strict):
    """Values in blocks, each with batches of its own; a value in several blocks belongs to the first."""

    blocks: Annotated[list[Block], Field(min_length=1)]


Axis = Annotated[Listed | Annotated[AxisRange, Tag("AxisRange")] | Annotated[BlocksOf, Tag("BlocksOf")], _BY_KIND]


def blocks_of(axis: list[Any] | AxisRange | BlocksOf, resolution: int = 1) -> Blocks:
    """Blocks of the values of an axis; raises ValueError if there are too many values."""
    if isinstance(axis, BlocksOf):
        return tuple(block for part in axis.blocks for block in blocks_of(part, resolution))
    return axis.blocks(resolution) if isinstance(axis, AxisRange) else (tuple(axis),)


VARIED = (*Parameters.model_fields, *RATIOS, START, *PERTURBATIONS)  # what a grid may vary, in this order


class _Columns(Strict):
    _unknown: ClassVar[str] = "cannot be an axis"


_WORDS = {START: "where the motion starts: names of starts", "disc": "discs: tables of modes, or names of `discs`"}


def _described(name: str) -> dict[str, Any]:
    if name in _WORDS:
        return {"description": _WORDS[name]}
    if field := Parameters.model_fields.get(name):
        return {"description": field.description, "json_schema_extra": field.json_schema_extra}
    stated = attributes(name)
    return {"description": stated["long_name"], "json_schema_extra": {"unit": stated["units"]}}


_columns: dict[str, Any] = {name: (Axis, Field(None, **_described(name))) for name in VARIED}
Columns = create_model("Columns", __base__=_Columns, **_columns)  # an axis for each of several names of `VARIED`


class BatchSpec(Strict):
    """Division of the points of a grid into jobs."""

    # dimensions that are cut, where each value of the others has batches of its own; if not given, the first ones are,
    # as far as `size` requires. For a plane at once: its two, by default the only ones that are numbers, then those
    # whose values share a batch, by default all others
    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] | None = None  # most points in a batch; if not given, about 20 s of work
    tile: Annotated[Count, Field(ge=1)] = 32  # approximate intervals along the side of a tile of a plane


# ---- Named cases


def _in_part(model: type[pydantic.BaseModel], **others: Any) -> type[Strict]:
    """What may be said of a model in part: the rest is inherited. The others are types of fields that are models."""
    fields: dict[str, Any] = {
        name: (others.get(name, Annotated[field.annotation, *field.metadata, "in part"]) | None, None)
        for name, field in model.model_fields.items()
    }
    return create_model(f"Some{model.__name__.removesuffix('Spec')}", __base__=Strict, __doc__=model.__doc__, **fields)


class RecordSpec(Strict):
    """What is recorded of a case. Figures and claims refer to windows by their names."""

    windows: dict[WindowName, Window] = Field({})
    poincare: Poincare | None = None
    events: bool | Span = True
    audit_every_step: bool = False


SomeRecord = _in_part(RecordSpec, windows=dict[WindowName, _in_part(Window) | None])  # type: ignore[misc]
_ratios: dict[str, Any] = {name: (Positive | None, Field(None, **_described(name))) for name in RATIOS}
_WithRatios = create_model("_WithRatios", __base__=SomeParameters, **_ratios)
_BY = "quantity by which n_diameters: auto chooses the modes"


class GivenParameters(_WithRatios):  # type: ignore[misc, valid-type]
    """Parameters, or ratios of them, any of which may be left out; the number of modes may be left to each case."""

    n_diameters: Annotated[
        int,
        *Parameters.model_fields["n_diameters"].metadata,
        pydantic.WrapValidator(lambda value, check: value if value == AUTO else check(value)),
        WithJsonSchema({"anyOf": [{"type": "integer", "minimum": -1, "maximum": 60}, {"const": AUTO}]}),
    ] = Field(None, **_described("n_diameters"))
    truncation_quantity: Literal[*CHOSEN_BY] = Field(None, description=_BY)  # type: ignore[valid-type]
    truncation_tolerance: Annotated[Finite, Field(ge=TRUSTED)] = Field(  # type: ignore[assignment]
        None, description="relative tolerance of this quantity"
    )


def _mapping(raw: Any) -> Mapping[str, Any]:
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return raw


class NamedCase(Strict):
    """One named simulation of a study."""

    title: str = ""
    reference: str = ""
    parameters: Annotated[
        tuple[Parameters, ModeRequest | None],
        PlainValidator(lambda raw: read_asked(_mapping(raw)), json_schema_input_type=GivenParameters),
    ] = Field({}, validate_default=True)
    t_end: Seconds
    tol: Tolerance = 1e-10
    stop_at: Literal["first_separation"] | None = None
    start: Start = Start()
    ramps: tuple[Ramp, ...] = ()
    record: Annotated[RecordSpec, BeforeValidator(lambda raw: raw, json_schema_input_type=SomeRecord)] = RecordSpec()

    def spec(self) -> CaseSpec:
        """The specification to simulate; raises `ParameterError` with places inside the case."""
        faults: list[Fault] = []
        (p, request), record, truncation, modes = self.parameters, self.record, "", ""
        if request is not None and request.quantity != FREQUENCIES:  # the modes are chosen when the case runs
            modes = json.dumps(request.model_dump(), sort_keys=True)
        elif request is not None:
            try:
                choice = by_frequencies(p, request.tolerance)
                p, truncation = choice.parameters, choice.to_json()
            except DiscModelError as error:  # no number of modes meets the tolerance
                faults.append(Fault.of(("parameters", "n_diameters"), AUTO, str(error)))
        spans: dict[tuple[str, ...], Any] = {("windows", name): window for name, window in record.windows.items()}
        if record.events:
            spans["events",] = Span() if record.events is True else record.events
        for path, span in spans.items():
            start, stop = span.ends(0.0, self.t_end)
            if 0 <= start < stop <= self.t_end:
                spans[path] = span.resolved(0.0, self.t_end)
            else:
                rule = f"must be within the run: 0 <= start={start:g} < stop={stop:g} <= t_end={self.t_end:g}"
                faults.append(Fault(("record", *path), "", rule))
        for fault in ramp_faults(p, self.ramps, poincare=record.poincare is not None) if self.ramps else ():
            faults.append(fault.inside(("parameters",)) if fault.path[0] in Parameters.model_fields else fault)
        raise_faults(faults)
        events = spans.pop(("events",), None)
        windows = tuple((name, window) for (_, name), window in spans.items())
        rest = {name: getattr(self, name) for name in ("t_end", "tol", "stop_at", "start", "ramps")}
        rest |= {name: getattr(record, name) for name in ("poincare", "audit_every_step")}
        rest |= {"windows": windows, "events": events and (events.start, events.stop)}
        return CaseSpec(parameters=p, truncation=truncation, modes=modes, **rest)


# ---- Figures


def _figure(raw: Any) -> Kind:
    return raw if isinstance(raw, Kind) else kind_of(_mapping(raw).get("kind")).model_validate(raw)


_OTHER_NAME = {"kind": {"type": "string", "pattern": r"^\w+\.\w+$"}}
_OTHER_KIND = Annotated[Any, WithJsonSchema({"type": "object", "properties": _OTHER_NAME, "required": ["kind"]})]
_KIND: Any = Annotated[Union[*(kind for _, kind in sorted(kinds_in("").items()))], Field(discriminator="kind")]
Figure = Annotated[Kind, PlainValidator(_figure, json_schema_input_type=_KIND | _OTHER_KIND)]
"""A figure of any kind; the schema for editors knows the keys of the library's kinds, and not those of the paper's."""

# ---- The whole document


def _given_figures(raw: Any) -> Any:
    """Figures by their names, without those that null drops."""
    return {name: plot for name, plot in raw.items() if plot is not None} if isinstance(raw, Mapping) else raw


def _several(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


def _known(name: str | None) -> str | None:
    if name is not None and "status" not in quantity_of(name).COLUMNS:
        raise ParameterError(Fault.of((), name, "COLUMNS of its class must contain 'status'"))
    return name


def _options(raw: Any, info: pydantic.ValidationInfo) -> Any:
    """The quantity with its options; what is given for an unknown one is checked once it is known."""
    quantity = info.data.get("quantity")
    return raw if quantity is None else quantity_of(quantity).model_validate(_mapping(raw))


class Document(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md."""

    study: Name
    title: str = ""
    base: GivenParameters = GivenParameters()
    figures: Annotated[
        dict[Name, Figure], BeforeValidator(_given_figures, json_schema_input_type=dict[Name, Figure | None])
    ] = Field({})
    tol: Tolerance | None = 1e-10  # of all cases, as `record`
    record: SomeRecord = SomeRecord()  # type: ignore[valid-type]
    cases: Annotated[dict[CaseName, NamedCase], Field(min_length=1)] = Field({}, validate_default=False)
    claims: bool = False  # whether the paper's claims and tables are checked against the cases
    quantity: Annotated[str | None, AfterValidator(_known), WithJsonSchema({"enum": quantity_names()})] = None
    options: Annotated[Any, PlainValidator(_options), WithJsonSchema({"type": "object"})] = None
    axes: Columns = Columns()
    where: Annotated[
        tuple[Annotated[str, AfterValidator(checked_rule)], ...],
        BeforeValidator(_several, json_schema_input_type=str | list[str]),
    ] = ()
    zip: Annotated[tuple[Columns, ...], BeforeValidator(_several, json_schema_input_type=Columns | list[Columns])] = ()
    batch: BatchSpec = BatchSpec()
    starts: dict[StartName, Start] = Field({})
    discs: dict[str, Annotated[Disc, WithJsonSchema({"type": "string"})]] = Field({})
    studies: tuple[str, ...] = ()  # further files of grid studies, * stands for any part of a name
    overrides: dict[str, dict[str, Any]] = Field({})  # of values in these files, by the name of the study
    resolution: Annotated[Count, Field(ge=1)] = 1  # divides the intervals of all ranges
