"""The model of a study file: `Document`.

Rules within one part are checked here, rules between parts in `disc_model.studies.study`. The module imports nothing
heavy. A job receives the values of all options, so this module is not among the sources of its result.
"""

import json
import re
from collections.abc import Collection, Mapping
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union

import pydantic
from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, Tag, WithJsonSchema, create_model

from disc_model.data.variables import BESIDE_WINDOWS, PERTURBATIONS, SCALARS, START, attributes
from disc_model.errors import DiscModelError, Fault, ParameterError
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
    """Refuse some names."""
    return AfterValidator(must(lambda name: name not in taken, rule))


_REPETITION = must(lambda name: not re.search(r"(.+)\1{19}$", name), "must not end in 20 equal parts")
Name = Annotated[
    str, pydantic.StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=100), AfterValidator(_REPETITION)
]
"""A name that files are called by; Snakemake takes a name that repeats itself for an endless recursion."""
CaseName = Annotated[Name, _but(TAKEN, "a case must not be called so, the name is taken by a variable")]
_WINDOW = "a window must not be called so, the name is taken by a variable or group"
WindowName = Annotated[Name, _but(TAKEN | BESIDE_WINDOWS, _WINDOW)]
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


_NO_AXIS = {
    "custom_error_type": "axis",
    "custom_error_message": "must be a list of values, or a range {start, stop, count or step}",
}
Listed = Annotated[list[NumberOrUnit], Field(min_length=1), Tag("a list")]
Block = Annotated[Listed | Annotated[AxisRange, Tag("AxisRange")], pydantic.Discriminator(_axis_kind, **_NO_AXIS)]


class BlocksOf(Strict):
    """Values in blocks, each with batches of its own; a value in several blocks belongs to the first."""

    blocks: Annotated[list[Block], Field(min_length=1)]


Axis = Annotated[
    Listed | Annotated[AxisRange, Tag("AxisRange")] | Annotated[BlocksOf, Tag("BlocksOf")],
    pydantic.Discriminator(_axis_kind, **_NO_AXIS),
]


def blocks_of(axis: list[Any] | AxisRange | BlocksOf, resolution: int = 1) -> Blocks:
    """Blocks of the values of an axis; raises ValueError if there are too many values."""
    if isinstance(axis, BlocksOf):
        return tuple(block for part in axis.blocks for block in blocks_of(part, resolution))
    return axis.blocks(resolution) if isinstance(axis, AxisRange) else (tuple(axis),)


VARIED = (*Parameters.model_fields, *RATIOS, START, *PERTURBATIONS)
"""Names that a grid may vary, in the order of its dimensions: parameters, ratios in their place, and the start."""


class _Columns(Strict):
    """Values by what varies."""

    _unknown: ClassVar[str] = "cannot be an axis"


def _described(name: str) -> dict[str, Any]:
    if name == START:
        return {"description": "where the motion starts: names of starts"}
    if name == "disc":
        return {"description": "discs: tables of modes, or names of `discs`"}
    if name in (*PERTURBATIONS, *RATIOS):
        stated = attributes(name)
        return {"description": stated["long_name"], "json_schema_extra": {"unit": stated["units"]}}
    field = Parameters.model_fields[name]
    return {"description": field.description, "json_schema_extra": field.json_schema_extra}


_columns: dict[str, Any] = {name: (Axis, Field(None, **_described(name))) for name in VARIED}
Columns = create_model("Columns", __base__=_Columns, **_columns)  # an axis for each of several names of `VARIED`


class BatchSpec(Strict):
    """Division of the points of a grid into jobs.

    over : dimensions that are cut; each value of the others has batches of its own. If not given, the first dimensions
        are cut as far as `size` requires
    size : greatest number of points in a batch; if not given, about 20 s of work by the cost of a point
    tile : approximate intervals along the side of a tile, for a quantity that needs a plane at once. `over` names its
        two dimensions first, then those whose values share a batch. If not given, the plane's are the only two that are
        numbers, and all other values share a batch
    """

    over: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    size: Annotated[Count, Field(ge=1)] | None = None
    tile: Annotated[Count, Field(ge=1)] = 32


# ---- Named cases


def _in_part(model: type[pydantic.BaseModel], **others: Any) -> type[Strict]:
    """What may be said of a model in part, since the rest is inherited; as null, to drop what is inherited.

    others : types of fields that are models themselves
    """
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


_diameters = Parameters.model_fields["n_diameters"]


_ratios: dict[str, Any] = {name: (Positive | None, Field(None, **_described(name))) for name in RATIOS}
_WithRatios = create_model("_WithRatios", __base__=SomeParameters, **_ratios)


class GivenParameters(_WithRatios):  # type: ignore[misc, valid-type]
    """Parameters, or ratios of them, any of which may be left out; the number of modes may be left to each case."""

    n_diameters: Annotated[
        int,
        *_diameters.metadata,
        pydantic.WrapValidator(lambda value, check: value if value == AUTO else check(value)),
        WithJsonSchema({"anyOf": [{"type": "integer", "minimum": -1, "maximum": 60}, {"const": AUTO}]}),
    ] = Field(  # type: ignore[assignment]
        None, description=_diameters.description, json_schema_extra=_diameters.json_schema_extra
    )
    truncation_quantity: Literal[*CHOSEN_BY] = Field(  # type: ignore[valid-type]
        None, description="quantity by which n_diameters: auto chooses the modes"
    )
    truncation_tolerance: Annotated[Finite, Field(ge=TRUSTED)] = Field(  # type: ignore[assignment]
        None, description="relative tolerance of this quantity"
    )


def _of_case(values: Any) -> tuple[Parameters, ModeRequest | None]:
    if not isinstance(values, Mapping):
        raise ValueError("must be a mapping")
    return read_asked(values)


SomeSpan = TypeVar("SomeSpan", bound=Span)


class NamedCase(Strict):
    """One named simulation of a study."""

    title: str = ""
    reference: str = ""
    parameters: Annotated[
        tuple[Parameters, ModeRequest | None], PlainValidator(_of_case, json_schema_input_type=GivenParameters)
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
        p, truncation, modes = self._modes(faults)
        record, events = self.record, None
        windows = {
            name: self._within(window, ("record", "windows", name), faults) for name, window in record.windows.items()
        }
        if record.events:
            span = self._within(Span() if record.events is True else record.events, ("record", "events"), faults)
            events = span.start, span.stop
        for fault in ramp_faults(p, self.ramps, poincare=record.poincare is not None) if self.ramps else ():
            faults.append(fault.inside(("parameters",)) if fault.path[0] in Parameters.model_fields else fault)
        if faults:
            raise ParameterError(*faults)
        of_case = {name: getattr(self, name) for name in ("t_end", "tol", "stop_at", "start", "ramps")}
        of_record = {name: getattr(record, name) for name in ("poincare", "audit_every_step")}
        recorded = of_record | {"windows": tuple(windows.items()), "events": events}
        return CaseSpec(parameters=p, truncation=truncation, modes=modes, **of_case, **recorded)

    def _modes(self, faults: list[Fault]) -> tuple[Parameters, str, str]:
        """Parameters, and how their modes were chosen or will be chosen when the case runs."""
        p, request = self.parameters
        if request is None or request.quantity != FREQUENCIES:
            return p, "", "" if request is None else json.dumps(request.model_dump(), sort_keys=True)
        try:
            choice = by_frequencies(p, request.tolerance)
        except DiscModelError as error:  # no number of modes meets the tolerance
            faults.append(Fault.of(("parameters", "n_diameters"), AUTO, str(error)))
            return p, "", ""
        return choice.parameters, choice.to_json(), ""

    def _within(self, span: SomeSpan, path: tuple[str, ...], faults: list[Fault]) -> SomeSpan:
        """A stretch of the run with absolute times."""
        start, stop = span.ends(0.0, self.t_end)
        if 0 <= start < stop <= self.t_end:
            return span.resolved(0.0, self.t_end)
        rule = f"must be within the run: 0 <= start={start:g} < stop={stop:g} <= t_end={self.t_end:g}"
        faults.append(Fault(path, "", rule))
        return span


# ---- Figures


def _figure(raw: Any) -> Kind:
    if isinstance(raw, Kind):
        return raw
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return kind_of(raw.get("kind")).model_validate(raw)


_OTHER_NAME = {"kind": {"type": "string", "pattern": r"^\w+\.\w+$"}}
_OTHER_KIND = Annotated[Any, WithJsonSchema({"type": "object", "properties": _OTHER_NAME, "required": ["kind"]})]
_KIND: Any = Annotated[Union[*(kind for _, kind in sorted(kinds_in("").items()))], Field(discriminator="kind")]
Figure = Annotated[Kind, PlainValidator(_figure, json_schema_input_type=_KIND | _OTHER_KIND)]
"""A figure of any kind; the schema for editors knows the keys of the library's kinds, and not those of the paper's."""


Figures = Annotated[
    dict[Name, Figure],
    BeforeValidator(
        lambda raw: {name: plot for name, plot in raw.items() if plot is not None} if isinstance(raw, Mapping) else raw,
        json_schema_input_type=dict[Name, Figure | None],
    ),
]
"""Figures by their names; null drops one that is inherited."""

# ---- The whole document


def _several(value: Any) -> Any:
    """A list, also of a single value."""
    return value if isinstance(value, list | tuple) else [value]


def _known(name: str | None) -> str | None:
    if name is not None and "status" not in quantity_of(name).COLUMNS:
        raise ParameterError(Fault.of((), name, "COLUMNS of its class must contain 'status'"))
    return name


def _options(raw: Any, info: pydantic.ValidationInfo) -> Any:
    """The quantity with its options; what is given for an unknown one is checked once it is known."""
    if (quantity := info.data.get("quantity")) is None:
        return raw
    if not isinstance(raw, Mapping):
        raise ValueError("must be a mapping")
    return quantity_of(quantity).model_validate(raw)


class Document(Strict):
    """A study: named cases, a grid of points, or both, and their figures; see docs/studies.md.

    study : name of the study, and of its folder of results
    title : subject of the study
    base : parameters of all cases and of all points; the rest is Table 1 of the paper
    figures : contents of each figure by its name
    cases : named simulations, with inherited values; `tol` and `record` are common to them
    claims : whether the paper's claims and tables are checked against the cases
    quantity, options : the quantity that a grid computes at each point
    axes, zip, starts : varying parameters, and starts of the motions
    discs : tables of modes by the names that an axis of discs has for them
    where : rules between values, such as mu_k <= mu_s; points that break one are excluded
    batch : division of the points into jobs
    studies : further files of grid studies, * stands for any part of a name
    overrides : values that replace those of these files, by name
    resolution : whole number that divides the intervals of all ranges
    """

    study: Name
    title: str = ""
    base: GivenParameters = GivenParameters()
    figures: Figures = Field({})
    tol: Tolerance | None = 1e-10
    record: SomeRecord = SomeRecord()  # type: ignore[valid-type]
    cases: Annotated[dict[CaseName, NamedCase], Field(min_length=1)] = Field({}, validate_default=False)
    claims: bool = False
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
    studies: tuple[str, ...] = ()
    overrides: dict[str, dict[str, Any]] = Field({})
    resolution: Annotated[Count, Field(ge=1)] = 1
