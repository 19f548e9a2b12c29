"""The map of a study: measures over one or two parameters, with theoretical boundaries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.regime.kinds import UNDETERMINED
from stiction.arrays import xr
from stiction.errors import DescriptionError
from stiction.plotting.maps import (
    Side,
    draw_changes,
    draw_critical,
    draw_kinds,
    draw_measure,
    draw_points,
    draw_regimes,
    draw_slice,
    draw_theory,
)
from stiction.plotting.page.canvas import as_list, grid_of, panel, whole_figure
from stiction.plotting.page.parameter import Scale, in_unit, parameter_symbol
from stiction.plotting.page.save import picture
from stiction.plotting.page.style import COLUMN, PAGE, style
from stiction.plotting.stability.damping import draw_damping_map
from stiction.study.plan.coordinates import ascending, path_along, values_at
from stiction.study.plan.layout import Index
from stiction.study.store.store import COMPLETED
from stiction.study.view.boundaries import Plane, critical_values, plane
from stiction.study.view.view import (
    NO_CYCLE,
    REGIME,
    View,
    choose_measures,
    kinds,
    undetermined_in_words,
    view_study,
)
from stiction.text.quantity.wording import in_words
from stiction.text.units import Quantity
from stiction.theory import damping_number_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SWINGS = ("amplitude", "force_drop")  # measures that are zero without a motion
WIDTH = 40  # characters of a title as wide as a column
DAMPING = ("phi", "drive.velocity")  # coordinates that locate a run in the damping diagram


class Map(NamedTuple):
    """The results of a study over one or two parameters, ready to be drawn.

    Parameters
    ----------
    view : View
        The study and its store, cut to one or two dimensions.
    measures : tuple of str
        The measures to draw.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["stick_count"])
    >>> done = st.sweep(study, "phi.zarr")
    >>> found = st.map("phi.zarr")
    >>> found.data["stick_count"].sizes["phi"]
    3
    """

    view: View
    measures: tuple[str, ...]

    def __repr__(self) -> str:
        """Return a one-line summary."""
        return f"<Map of {', '.join(self.measures)} over {', '.join(self.dims)}>"

    def _repr_html_(self) -> str:
        return f"<h4>{escape(repr(self))}</h4>" + picture(plot_map, self)

    @property
    def data(self) -> xr.Dataset:
        """The dataset of the store after the cuts."""
        return self.view.data

    @property
    def dims(self) -> tuple[str, ...]:
        """The remaining dimensions."""
        return tuple(str(dim) for dim in self.data["status"].dims)

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw it; see `stiction.study.view.mapping.plot_map`."""
        return plot_map(self, axes)


def map(
    store: str | Path,
    of: str | Sequence[str] = (),
    at: Mapping[str, Quantity] | None = None,
    *,
    trust: bool = False,
) -> Map:
    """Return the results of a study, finished or not, over one or two of its parameters.

    Parameters
    ----------
    store : str or Path
        A store of `stiction.sweep`.
    of : str or sequence of str, optional
        Measures to draw, a panel each; by default the regime, if it was kept.
    at : mapping, optional
        From a dimension to the value at which it is cut (a number, or text with its unit); the
        nearest value of the study is taken, and one beyond its ends refused.
    trust : bool, optional
        Whether the text of a friction law in the store may be run; see `stiction.load`.

    Returns
    -------
    Map
        Its ``data``, and its ``plot()``.

    Raises
    ------
    ResultError
        If `store` is not the store of a study.
    DescriptionError
        If there is no such measure or dimension, or more than two dimensions remain.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["stick_count"])
    >>> done = st.sweep(study, "phi.zarr")
    >>> st.map("phi.zarr").dims
    ('phi',)
    """
    measures = [of] if isinstance(of, str) else of
    view = view_study(store, at or {}, trust, measures)
    if {*measures} - {REGIME} and are_points(view):
        message = "samples of several parameters are drawn by their kind of motion alone"
        raise DescriptionError.of("of", f"{message}; leave it out, or use xarray.open_zarr")
    return Map(view, tuple(choose_measures(view, measures)))


def plot_map(found: Map, axes: Axes | Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw a study: a map over two dimensions, a curve over one, points for samples.

    Parameters
    ----------
    found : Map
        From `stiction.map`.
    axes : Axes or sequence of Axes, optional
        Drawn on, one for each measure; by default a new figure, as wide as a column, or as a page
        for several.

    Returns
    -------
    ndarray of Axes
        One for each measure.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["stick_count"])
    >>> done = st.sweep(study, "phi.zarr")
    >>> axes = st.plotting.plot_map(st.map("phi.zarr"))
    """
    view = in_order(found.view)
    with style():
        if len(found.dims) == 2:
            panels = _maps(view, found.measures, axes)
        elif are_points(view):
            panels = _points(found.view, axes)
        else:
            panels = _curves(view, found.measures, axes)
        said = [cut(view)] if view.at else []
        said += [each] if (each := gaps_in_words(found)) else []
        if said:
            wide = whole_figure(panels[0]).get_figwidth() / COLUMN
            lines = (fill(each, int(WIDTH * wide)) for each in said)
            panels[0].set_title("\n".join(lines), loc="left")
        return np.array(panels, dtype=object)


def are_points(view: View) -> bool:
    """Return whether a view has one dimension, along which several parameters vary together."""
    names = [name for name, each in view.study.coordinates.items() if each.dim not in view.at]
    return len(view.data["status"].dims) == 1 and len({*names} - {"run.duration"}) > 1


def cut(view: View) -> str:
    """Return the values at which a study is cut, for a title: the study's nearest ones."""
    known = values_at(view.study.coordinates, view.at)
    values = (f"{parameter_symbol(name)} = {in_words(*its)}" for name, its in known.items())
    return f"at {', '.join(values)}"


def gaps_in_words(found: Map) -> str:
    """Return how many runs of a map ended well but are not determined, and why; '' for none.

    Where kinds of motion are drawn, a run of none is one, whether it has a message or not.
    """
    view = found.view
    messages, ended = view.data["message"].values, view.data["status"].values == COMPLETED
    if REGIME in view.data and (REGIME in found.measures or len(found.dims) == 1):
        blank = (kinds(view.data) == UNDETERMINED) & (messages == "")
        messages = np.where(blank, NO_CYCLE, messages)
    whys = [str(each) for each in messages[ended] if each]
    return undetermined_in_words(whys, view.data["status"].size)


def side(view: View, dim: str, values: np.ndarray | None = None) -> Side:
    """Return a side of a map, with the study's values or others in the same unit."""
    known = view.study.coordinates
    path = path_along(known, dim)
    own, unit = known[path].values[ascending(known, dim)], known[path].unit
    log = len(own) > 2 and bool((own > 0.0).all()) and unevenness(np.log(own)) < unevenness(own)
    factor, shown = (1.0, "deg") if unit == "deg" else in_unit(np.median(np.abs(own)), unit)
    scale = Scale(parameter_symbol(path), factor, shown)
    return Side(scale, scale.in_unit(own if values is None else values), log)


def in_order(view: View) -> View:
    """Return a view with its runs in ascending order of their values."""
    known = view.study.coordinates
    order = {dim: ascending(known, str(dim)) for dim in view.data["status"].dims}
    return view._replace(data=view.data.isel(order))


def unevenness(values: np.ndarray) -> float:
    """Return the unevenness of values: 0 for equal distances."""
    steps = np.diff(values)
    return float(np.std(steps) / np.abs(np.mean(steps))) if np.mean(steps) else np.inf


def _maps(view: View, measures: Sequence[str], axes: Any) -> list[Axes]:
    x_dim, y_dim = view.data["status"].dims
    theory = plane(view.study, str(x_dim), str(y_dim), view.at)
    columns = min(len(measures), 2)
    rows = -(-len(measures) // columns)
    width = COLUMN if columns == 1 else PAGE
    panels = grid_of(axes, (width, 2.9 * rows + 0.4), rows, columns)
    handles: list[Any] = []
    for ax, name in zip(panels, measures, strict=False):
        handles += _map(ax, view, name, theory)
    for ax in panels[len(measures) :]:
        ax.set_axis_off()
    unique = {handle.get_label(): handle for handle in handles}
    if unique and axes is None:
        write_legend(whole_figure(panels[0]), [*unique.values()], 2 * columns)
    elif unique:
        panels[0].legend(handles=[*unique.values()], loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return list(panels[: len(measures)])


def write_legend(figure: Figure, handles: Sequence[Any], columns: int) -> None:
    """Write a legend above the panels, in at most `columns` columns, within the figure's width."""
    for count in range(columns, 0, -1):
        legend = figure.legend(handles=handles, loc="outside upper center", ncols=count)
        if count == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return
        legend.remove()


def measure_in_unit(data: xr.Dataset, name: str) -> tuple[np.ndarray, str]:
    """Return a measure in a unit that suits its largest value, and its name with the unit."""
    values = data[name].values
    known = np.abs(values[np.isfinite(values)])
    largest = known.max() if len(known) else 1.0
    factor, unit = in_unit(largest, str(data[name].attrs.get("units", "1")))
    return factor * values, f"{name.replace('_', ' ')} ({unit})"


def _map(ax: Axes, view: View, name: str, theory: Plane) -> list[Any]:
    """Draw one map with the theory over it; return the handles of the legend."""
    x, y = (side(view, str(dim)) for dim in view.data[name].dims)
    handles: list[Any] = []
    if name == REGIME:
        handles += draw_regimes(ax, x, y, kinds(view.data))
    else:
        handles += draw_measure(ax, x, y, *measure_in_unit(view.data, name))[1]
    x_dim, y_dim = (str(dim) for dim in view.data[name].dims)
    fine = side(view, x_dim, theory.x), side(view, y_dim, theory.y)
    for found in view.changes:
        if {x_dim, y_dim} <= {*found.data_vars} and not view.at:
            places = (_place(view, found, (x_dim, y_dim), share) for share in (-1.0, 1.0))
            x_at, y_at = _place(view, found, (x_dim, y_dim), 0.0)
            handles += draw_changes(ax, x_at, y_at, *places)
    return handles + draw_theory(ax, *fine, theory.fields)


def _place(view: View, found: xr.Dataset, dims: tuple[str, str], share: float) -> tuple[Side, Side]:
    """Return where refined changes lie on a map, or the ends of their intervals (share -1, 1)."""
    off = {found.attrs["along"]: share * found["half_width"].values}
    x, y = (side(view, dim, found[dim].values + off.get(dim, 0.0)) for dim in dims)
    return x, y


def _curves(view: View, measures: Sequence[str], axes: Any) -> list[Axes]:
    dim = str(view.data["status"].dims[0])
    count = len(measures)
    panels = grid_of(axes, (COLUMN, 1.1 + 1.7 * count), count, 1, sharex=True)
    here, known = side(view, dim), list(kinds(view.data)) if REGIME in view.data else []
    critical = side(view, dim, critical_values(view.study, dim, view.at))
    handles: list[Any] = []
    for ax, name in zip(panels, measures, strict=True):
        if name == REGIME:
            draw_kinds(ax, here, known)
        else:
            values, label = measure_in_unit(without_noise(view, name), name)
            handles += draw_slice(ax, here, values, label, known)
        handles += draw_critical(ax, critical)
        if ax is not panels[-1]:
            ax.set_xlabel("")
    unique = {handle.get_label(): handle for handle in handles}
    if unique and axes is None:
        write_legend(whole_figure(panels[0]), [*unique.values()], 3)
    elif unique:
        panels[0].legend(handles=[*unique.values()], loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return list(panels)


def without_noise(view: View, name: str) -> xr.Dataset:
    """Return a view's data in which swings below the tolerance of the runs are zero.

    That is relative to the largest normal load: what steady sliding has of them is rounding.
    """
    if name not in SWINGS:
        return view.data
    base, known = view.study.base, view.study.coordinates
    own = {"normal_load": base.slider.normal_load, "run.rtol": base.run.rtol}
    load, rtol = (
        float(np.max(known[path].values)) if path in known else value for path, value in own.items()
    )
    values = view.data[name]
    return view.data.assign({name: values.where(~(abs(values) < rtol * load), 0.0)})


def _points(view: View, axes: Any) -> list[Axes]:
    """Draw samples in the damping diagram, if their position in it is known."""
    (dim,) = view.data["status"].dims
    known = view.study.coordinates
    if not set(DAMPING) <= known.keys() or REGIME not in view.data:
        lacking = f"needs samples of {' and '.join(DAMPING)}, and the measure 'regime'"
        raise DescriptionError.of(str(dim), f"{lacking}; draw it from xarray.open_zarr")
    indices: list[Index] = [(i,) for i in range(view.data.sizes[dim])]
    sliders = (view.study.description(index).slider for index in indices)
    A = np.array([damping_number_of(each, each.motion.velocity) for each in sliders])
    phi = known["phi"].values
    ax = panel(None if axes is None else as_list(axes)[0], 3.4)
    draw_damping_map(ax, (A.min() / 2, A.max() * 2), (phi.min() / 1.5, 90.0))
    handles = draw_points(ax, A, phi, list(kinds(view.data)))
    ax.set_ylabel(r"force angle $\theta$; points: $\varphi$ (deg)")
    ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return [ax]
