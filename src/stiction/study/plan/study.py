"""A study: a base description, axes over its parameters, and the variables to keep."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache, partial
from itertools import product
from pathlib import Path
from typing import Annotated, Any, ClassVar, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from stiction.drive.recorded.reading import Locate, locate_nothing, locator
from stiction.errors import DescriptionError, Fault, echo
from stiction.formats.table import number_of
from stiction.friction.user.loading import Find, finder_for_descriptions, finder_for_results, is_own
from stiction.names import old_method
from stiction.study.plan.axes import axis_table
from stiction.study.plan.coordinates import (
    Coordinate,
    coordinate_faults,
    coordinates,
    nearest,
    stated_unit,
    unit,
    values_at,
    vary,
)
from stiction.study.plan.layout import Index, Layout, axis_faults, layout_of, run_faults
from stiction.study.plan.reading import (
    axes_of,
    is_description,
    measures_of,
    read_axes,
    references_of,
    traces_of,
    unknown_axes,
    varied_faults,
    with_functions,
)
from stiction.study.variables.measures import DEFAULT
from stiction.study.variables.observed_run import seconds_of
from stiction.study.variables.own import (
    FindMeasure,
    OwnMeasure,
    measures_in_folder,
    measures_of_results,
)
from stiction.system import parameter
from stiction.system.description import Description
from stiction.system.writing import parameter_table, slider_tables
from stiction.text.sections import Section, as_html
from stiction.text.toml import folder_of, read_changed, read_json
from stiction.text.units import Quantity, Read, Whole
from stiction.text.validation import Described, faulty, unknown_name

HERE = "; another process knows the text only: give the value there, or take engine=st.Threads()"


class Study(Described):
    """Many runs: a base description, and axes over any of its parameters.

    Parameters
    ----------
    base : Description
        The description that all runs share.
    axes : mapping of str to Grid, Values, Random or Sobol
        From the path of a parameter (``phi``, ``drive.velocity``, ``friction.mu_0``, ``k_x, k_y``
        for two that share a value; see `stiction.study.plan.coordinates`) to an axis, or to a
        table of the same.
    measures : sequence of str or callable, optional
        Numbers to keep of each run: names in `stiction.study.variables.measures.MEASURES`, and
        functions of your own from a `Trajectory` to a number. The annotation of what one returns
        may give its unit: ``-> Annotated[float, "deg"]``.
    traces : sequence of str, optional
        Time series to keep as well: "force", "velocity", "position".
    trace_samples : int, optional
        Number of samples of each trace, evenly spaced over the run.
    seed : int, optional
        Seed of random and Sobol axes.

    Raises
    ------
    DescriptionError
        With every fault at once.

    Examples
    --------
    >>> import stiction as st
    >>> base = st.Description.of(st.presets.nakano_popov_2020(), 5)
    >>> study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "10 deg", 10),
    ...                                   "drive.velocity": st.Values(["1 mm/s", "2 mm/s"])})
    >>> study.layout.runs
    20
    """

    _independent: ClassVar[bool] = True

    base: Annotated[Any, AfterValidator(is_description)]
    axes: Annotated[Any, BeforeValidator(axes_of)]
    measures: Annotated[Read[tuple[Any, ...]], BeforeValidator(measures_of)] = DEFAULT
    traces: Annotated[Read[tuple[str, ...]], BeforeValidator(traces_of)] = ()
    trace_samples: Annotated[Whole, Field(ge=2, le=100_000)] = 256
    seed: Annotated[Whole, Field(ge=0, lt=2**63)] = 0

    @model_validator(mode="after")
    def _can_be_laid_out(self) -> Self:
        if found := self._taken_names() or self._too_large() or self._check_endpoints():
            raise faulty(found)
        return self

    def _taken_names(self) -> list[Fault]:
        """Return a fault for each user's measure that has the name of an axis."""
        names = {*self.axes, *(axis.along for axis in self.axes.values())}
        own = [each.name for each in self.measures if isinstance(each, OwnMeasure)]
        said = "is the name of an axis, too; give your function another name"
        return [Fault("measures", f"{name} {said}") for name in own if name in names]

    def _too_large(self) -> list[Fault]:
        """Return the faults of a study that does not fit into memory."""
        kept = (len(self.measures), len(self.traces), self.trace_samples)
        return [*axis_faults(self.axes), *run_faults(self.layout, *kept)]

    def _check_endpoints(self) -> list[Fault]:
        """Check the endpoints of each dimension.

        An endpoint is a fault if it is invalid at both ends of all other dimensions. Otherwise
        only the single runs are refused. A value that is invalid by itself is a fault of its own
        axis alone.
        """
        found: dict[str, Fault] = {}
        ends = [sorted({0, size - 1}) for size in self.layout.shape]
        for place, dim in enumerate(self.layout.dims):
            own = self._parameters(dim)
            others = set().union(*map(self._parameters, self.layout.dims)) - own
            for end in ends[place]:
                corners = product(*ends[:place], [end], *ends[place + 1 :])
                refusals = [
                    [fault for fault in self._refusal(index) if fault.path not in others]
                    for index in corners
                ]
                if all(refusals):
                    said = [x.message if {x.path} == own else str(x) for x in refusals[0]]
                    found.setdefault(dim, Fault(f"axes.{dim}", "; ".join(dict.fromkeys(said))))
        return list(found.values())

    def _parameters(self, dim: str) -> set[str]:
        """Return the paths of the parameters that vary along a dimension."""
        paths = (path for path, axis in self.axes.items() if (axis.along or path) == dim)
        return {name for path in paths for name in parameter.names(path)}

    def _refusal(self, index: Index) -> tuple[Fault, ...]:
        try:
            self.description(index)
        except DescriptionError as error:
            return error.faults
        return ()

    @cached_property
    def layout(self) -> Layout:
        """The grid of runs and its blocks."""
        sizes = {axis.along or path: axis.count for path, axis in self.axes.items()}
        return layout_of(sizes, seconds_of(self.base))

    @cached_property
    def coordinates(self) -> dict[str, Coordinate]:
        """The values of each axis."""
        return coordinates(self.base, self.axes, self.seed)

    def description(self, at: Index | Mapping[str, Quantity]) -> Description:
        """Return the description of one run.

        Parameters
        ----------
        at : mapping or tuple of int
            From each dimension to a value (a number, or text with its unit), of which the nearest
            of the study is taken, as by `stiction.map`; or the indices of the run in the store.

        Raises
        ------
        DescriptionError
            If the study does not have this run, or its base cannot have this combination of values.

        Examples
        --------
        >>> import stiction as st
        >>> slider = st.presets.nakano_popov_2020()
        >>> base = st.Description.of(slider, "5 s")
        >>> study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "10 deg", 10)})
        >>> study.description({"phi": "3 deg"}).slider == slider.replace(phi="3 deg")
        True
        """
        places = self._place(at) if isinstance(at, Mapping) else at
        try:
            values = values_at(self.coordinates, dict(zip(self.layout.dims, places, strict=True)))
        except (IndexError, TypeError, ValueError):
            sizes = ", ".join(map("{} ({})".format, self.layout.dims, self.layout.shape))
            raise DescriptionError.of(
                "at", f"{echo(at)} is not a run of the study, of {sizes}; write an index for each"
            ) from None
        return vary(self.base, values)

    def _place(self, at: Mapping[str, Quantity]) -> Index:
        found, faults = nearest(self.coordinates, self.layout.dims, at)
        told = {fault.path for fault in faults}
        missing = [dim for dim in self.layout.dims if dim not in found and dim not in told]
        faults += [Fault(dim, "missing; give a value of the study") for dim in missing]
        if faults:
            raise DescriptionError([Fault(f"at.{path}", message) for path, message in faults])
        return tuple(found[dim] for dim in self.layout.dims)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        axes = " x ".join(f"{path} ({axis.count})" for path, axis in self.axes.items())
        return f"<{self._in_words()}: {axes}>"

    def _in_words(self) -> str:
        return f"Study of {number_of(self.layout.runs, 'run')}"

    def _repr_html_(self) -> str:
        axes = {"axes": {path: axis_table(axis) for path, axis in self.axes.items()}}
        kept = f"Stored of each run: {', '.join(map(str, (*self.measures, *self.traces)))}."
        return as_html(
            [
                Section(self._in_words(), [kept], parameter_table(axes)),
                Section("Base", [], parameter_table(slider_tables(self.base.slider))),
            ]
        )

    run: ClassVar[Callable[..., Any]] = old_method("Study.run(store)", "sweep(study, store)")
    refine: ClassVar[Callable[..., Any]] = old_method("Study.refine(store)", "refine(study, store)")

    @classmethod
    def from_toml(
        cls,
        path: str | Path,
        changes: Mapping[str, Any] | None = None,
        *,
        trust: bool = False,
    ) -> Self:
        """Read a study's file: a description with the additional tables [study] and [axes].

        `changes` and `trust` are those of `Description.from_toml`.

        Raises
        ------
        DescriptionError
            With every fault and its path, or the reason why the file cannot be read.
        """
        folder = folder_of(path)
        find, locate = finder_for_descriptions(folder, trust), locator(folder, trust)
        raw, strange = read_changed(path, changes)
        known = [*strange, *varied_faults(raw, changes or {})]
        own = measures_in_folder(folder, trust)
        return cls.from_dict(raw, find=find, locate=locate, find_measure=own, known=known)

    @classmethod
    def from_dict(
        cls,
        raw: Mapping[str, Any],
        *,
        find: Find | None = None,
        locate: Locate | None = None,
        find_measure: FindMeasure | None = None,
        known: Sequence[Fault] = (),
    ) -> Self:
        """Read a study from nested tables, as in the TOML file; `known` faults are reported too.

        First come the study's own tables, as code of the user's is not run beside a fault, then the
        base, and then the axes with it.
        """
        axes = raw.get("axes")
        rest = {key: value for key, value in raw.items() if key not in ("study", "axes")}
        own, found = cls._own_table(raw.get("study", {}), axes)
        found, lost = [*known, *found], [*unknown_axes(rest, axes)]
        waits = [*found, *lost] if is_own(raw.get("friction")) else ()
        try:
            base = Description.from_dict(rest, find=find, locate=locate, known=waits)
        except DescriptionError as error:
            also = _faults_of_axes(partial(stated_unit, rest), axes)
            told = dict.fromkeys([*found, *error.faults, *lost, *also])
            raise DescriptionError([*told]) from None
        if found:
            also = _faults_of_axes(partial(unit, base), axes)
            raise DescriptionError([*found, *also])
        find_measure = find_measure or measures_in_folder(Path())
        measures = with_functions(own.get("measures", DEFAULT), find_measure)
        return cls._make({**own, "measures": measures}, axes, base)

    @classmethod
    def _own_table(cls, own: Any, axes: Any) -> tuple[dict[str, Any], Sequence[Fault]]:
        """Return the known keys of the table [study], and the faults of it and of the axes."""
        if not isinstance(own, Mapping):
            return {}, [Fault("study", f"must be a table [study], is {echo(own)}")]
        places = {"axes": "[axes.phi]", "base": "[slider], [friction], [drive] and [run]"}
        said = "is not a key of this table; write"
        found = [Fault(f"study.{key}", f"{said} {places[key]}") for key in places if key in own]
        if axes is None and "axes" not in own:
            found.append(Fault("axes", "missing; write for example a table [axes.phi]"))
        keys = cls.model_fields.keys() - places
        strange = [key for key in own if key not in keys | places.keys()]
        found += [Fault(f"study.{key}", unknown_name("key", key, keys)) for key in strange]
        own = {key: own[key] for key in own if key in keys}
        if "measures" in own:
            own["measures"] = references_of(own["measures"])
        try:
            cls._make(own, axes, None)
        except DescriptionError as error:
            told = {"study.base", "axes" if axes is None else ""}
            found += [each for each in error.faults if each.path not in told]
        return own, found

    @classmethod
    def _make(cls, own: Mapping[str, Any], axes: Any, base: Any) -> Self:
        try:
            return cls(**{**own, "base": base, "axes": axes})
        except DescriptionError as error:
            raise DescriptionError([_in_file(fault) for fault in error.faults]) from None

    @classmethod
    def from_json(cls, text: str, *, trust: bool = False) -> Self:
        """Read a study that `to_json` wrote; for `trust` see `Description.from_json`."""
        return cls.from_dict(
            read_json(text),
            find=finder_for_results(trust),
            locate=locate_nothing,
            find_measure=measures_of_results(trust),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return nested tables, which `from_dict` reads."""
        base: Description = self.base
        own = [each.table() if isinstance(each, OwnMeasure) else each for each in self.measures]
        rest = self.model_dump(mode="json", exclude={"base", "axes", "measures"})
        return {
            "study": {"measures": own, **rest},
            "axes": {path: axis_table(axis) for path, axis in self.axes.items()},
            **base.to_dict(),
        }

    def to_json(self) -> str:
        """Return the study as one JSON string."""
        return json.dumps(self.to_dict())

    def __reduce__(self) -> tuple[Callable[[str, bool], Study | UnreadStudy], tuple[str, bool]]:
        """Pickle as text, which other processes can read, including users' laws.

        Measures that may not be run here may not be run there.
        """
        return _from_text, (self.to_json(), not _without_function(self))


def _faults_of_axes(unit_at: Callable[[str], str | None], axes: Any) -> list[Fault]:
    """Return the faults of the readable axes."""
    found = coordinate_faults(unit_at, read_axes(axes)[0], seed=0)
    return [Fault(f"axes.{fault.path}", fault.message) for fault in found]


def _without_function(study: Study) -> list[OwnMeasure]:
    """Return the measures without a function that may be run."""
    own = (each for each in study.measures if isinstance(each, OwnMeasure))
    return [each for each in own if each.function is None]


class UnreadStudy(NamedTuple):
    """A study that another process could not read from its text: the faults."""

    faults: tuple[Fault, ...]


@lru_cache(maxsize=4)
def _from_text(text: str, trust: bool) -> Study | UnreadStudy:
    """Read a study in another process; its errors come later, as dask waits for ever for it."""
    raw, find = read_json(text), finder_for_results(trust=True)  # its law was made here
    own = measures_of_results(trust)
    try:
        study = Study.from_dict(raw, find=find, locate=locate_nothing, find_measure=own)
        return study_of(study) if trust else study
    except DescriptionError as error:
        return UnreadStudy(
            tuple(each._replace(message=each.message + HERE) for each in error.faults)
        )


def _in_file(fault: Fault) -> Fault:
    """Return a fault with its path in the file of a study."""
    path = fault.path.removeprefix("Study.")
    return Fault(path if path.startswith("axes") else f"study.{path}", fault.message)


def study_of(source: Study | UnreadStudy | str | Path) -> Study:
    """Return a study, the given one or that of a file, all of whose measures can be run.

    Raises
    ------
    DescriptionError
        If it is neither, or has measures that may not be run, or are others now.
    """
    if isinstance(source, str | Path):
        return Study.from_toml(source)
    if not isinstance(source, Study):
        if isinstance(source, UnreadStudy):
            raise DescriptionError(source.faults)
        remedy = "make one with st.Study(...), or give the path of its file"
        raise DescriptionError.of("study", f"{echo(source)} is not a Study; {remedy}")
    for each in source.measures:
        if isinstance(each, OwnMeasure):
            each.refuse_others()
    return source
