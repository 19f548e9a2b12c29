"""The interface that a user sees: names, signatures, help, texts that can be pasted back, TOML."""

import inspect
import pydoc
import re
import typing

import numpy as np
import pytest
from pydantic import BaseModel

import stiction as st
from stiction.friction import LAWS
from stiction.text.validation import Described

PIECES = (
    st.protocols.Constant,
    st.protocols.Step,
    st.protocols.Ramp,
    st.protocols.Hold,
    st.protocols.Reversal,
    st.protocols.Harmonic,
    st.protocols.Modulation,
    st.protocols.Free,
)
TUPLES = (*LAWS.values(), st.laws.Anisotropic, st.ConstantVelocity, *PIECES)
DESCRIBED = (
    st.Slider,
    st.Settings,
    st.Initial,
    st.protocols.DriveProgram,
    st.protocols.LoadProgram,
    st.Record,
)
SESSION = {"st": st}


def pieces(random, change):
    """Two or three pieces of a program; `change` is the size of its values."""
    to, by, swing = change * random.uniform(0.5, 1.0, 3)
    phase = f"{random.uniform(-180, 180)!r} deg"
    choices = [
        st.protocols.Ramp(to, random.uniform(0.1, 2.0)),
        st.protocols.Step(by, duration="1 s"),
        st.protocols.Hold(random.uniform(1e-4, 1.0)),
        st.protocols.Harmonic(swing, random.uniform(1.0, 1e4), phase, duration="0.3 s"),
        st.protocols.Constant(to, duration=1),
        st.protocols.Constant(duration=1),
    ]
    return [choices[i] for i in random.permutation(len(choices))[:3]]


def system(random):
    """A slider with any law, drive, load and numbers."""
    kind = list(LAWS.values())[random.integers(len(LAWS))]
    static, speed = random.uniform(0.4, 0.9), 10 ** random.uniform(-6, -1)
    law = kind.like(static, static - random.uniform(0.05, 0.3), speed)
    if not hasattr(law, "states") and random.random() < 0.3:
        law = st.laws.Anisotropic(law, random.uniform(0.5, 2.0), f"{random.uniform(-90, 90)!r} deg")
    V = 10 ** random.uniform(-6, 0)
    wave = st.protocols.Modulation(0.1 * V, 10 ** random.uniform(0, 4), "0.3 rad")
    program = st.protocols.DriveProgram(velocity=V, program=pieces(random, V), repeat=2, along=wave)
    drives = [st.ConstantVelocity(V), program, st.protocols.DriveProgram(velocity=-V, across=wave)]
    load = st.protocols.LoadProgram(
        program=pieces(random, 10.0), modulation=st.protocols.Modulation(0.1, 3.0)
    )
    return st.Slider(
        mass=10 ** random.uniform(-12, 3),
        k_x=10 ** random.uniform(-1, 9),
        k_y=float(f"{10 ** random.uniform(-1, 9):.3g}"),
        phi=[f"{random.uniform(-90, 90)!r} deg", f"{random.integers(-900, 900) / 10} deg"][
            random.integers(2)
        ],
        normal_load=10 ** random.uniform(-9, 4),
        friction=law,
        drive=drives[random.integers(3)],
        load=[None, load][random.integers(2)],
        c_x=[0.0, 10 ** random.uniform(-6, 3)][random.integers(2)],
        driven=["plate", "spring"][random.integers(2)],
    )


def test_any_slider_is_written_and_read_again_exactly():
    random = np.random.default_rng(20)
    for _ in range(200):
        slider = system(random)
        assert st.Slider.from_toml(slider.to_toml()) == slider
        assert eval(repr(slider), dict(SESSION)) == slider
        assert str(slider) == repr(slider)
        start = st.Initial(u_x=random.uniform(-1, 1), v_x="1 mm/s", v_y=0, time=0.25)
        settings = st.Settings(duration=random.uniform(0, 1e3), sample_rate="20 kHz", rtol=1e-8)
        whole = st.Description(slider, start, settings)
        assert st.Description.from_toml(whole.to_toml()) == whole
        assert eval(repr(whole), dict(SESSION)) == whole


def test_a_description_in_toml_is_one_that_people_write(slider, tmp_path):
    text = st.Description(slider, st.Initial(), st.Settings(duration=5)).to_toml()
    assert 'k_y = "10 MN/m"\nphi = "1 deg"\n' in text
    assert "[initial]" not in text  # nothing that goes without saying
    assert '[run]\nduration = "5 s"\n' in text
    (tmp_path / "a.toml").write_text(text)
    assert st.Slider.from_toml(tmp_path / "a.toml") == slider
    with pytest.raises(st.DescriptionError, match="the text: is not TOML"):
        st.Slider.from_toml("[slider\n")


@pytest.mark.parametrize("kind", TUPLES, ids=lambda kind: kind.__name__)
def test_signatures_show_parameters_units_and_defaults(kind):
    signature = inspect.signature(kind)
    assert tuple(signature.parameters) == kind._fields
    for name, parameter in signature.parameters.items():
        assert (parameter.default is parameter.empty) == (name not in kind._field_defaults)
        assert parameter.annotation is not parameter.empty
    assert "Annotated" not in str(signature)


def test_units_stand_in_signatures():
    assert str(inspect.signature(st.protocols.Step)) == (
        "(by: float (m/s or N) | str | None = None, duration: float (s) | str | None = None, "
        "to: float (m/s or N) | str | None = None)"
    )
    assert "v_f: float (m/s) | str" in str(inspect.signature(st.ExponentialWeakening))
    assert "phi: str (deg or rad)" in str(inspect.signature(st.Slider))


@pytest.mark.parametrize("kind", DESCRIBED, ids=lambda kind: kind.__name__)
def test_nobody_meets_the_library_that_reads_descriptions(kind):
    inherited = {name for name in dir(BaseModel) if not name.startswith("__")}
    assert issubclass(kind, Described)
    assert not inherited & {*dir(kind)}
    text = pydoc.render_doc(kind, renderer=pydoc.plaintext)
    assert not [name for name in inherited if f" {name}(" in text]
    assert "__pydantic" not in text
    assert "Annotated" not in str(inspect.signature(kind))


def test_dir_lists_fields_properties_and_methods(slider):
    assert {"mass", "phi", "friction", "replace", "to_toml", "F_0"} <= {*dir(slider)}
    assert not {"model_dump", "model_fields", "copy", "json", "dict"} & {*dir(slider)}
    assert slider.model_dump()  # there all the same


def test_friction_on_the_mass_points_the_same_way_in_every_figure(slider):
    from matplotlib.figure import Figure

    from stiction.plotting.apparatus.vectors import friction_vector

    run = st.simulate(slider, "0.1 s", sample_rate="10 kHz")
    force = friction_vector(run.data)
    moving = run.data["slip_speed"].values > 0
    slip = np.column_stack([run.data["slip_x"], run.data["slip_y"]])
    c, s = slider.direction
    lab = slip @ np.array([[c, -s], [s, c]])  # along X and Y
    assert (np.sum(force * lab, axis=1)[moving] < 0).all()

    from stiction.plotting.apparatus.schematic import draw_schematic

    ax = draw_schematic(Figure().subplots(), slider)
    assert ax.texts
    names = {text.get_text(): np.array(text.get_position()) for text in ax.texts}
    assert names["$F$"] @ names[r"$v_\mathrm{slip}$"] < 0
    # as in the circle: against the drive, and across it where the slip is not
    assert np.sign(names["$F$"]).tolist() == np.sign(force[moving].mean(axis=0)).tolist()


def test_angles_are_in_degrees_wherever_they_are_data(slider):
    run = st.simulate(slider, "0.1 s", sample_rate="1 kHz")
    assert run.data["theta"].attrs["units"] == run.data["psi"].attrs["units"] == "deg"
    lines = [line.split() for line in st.Slider.__doc__.splitlines()]
    for symbol in ("theta", "psi"):
        assert next(line for line in lines if line and line[0] == symbol)[-2] == "deg"
    assert slider.phi == np.radians(1.0)
    assert "``slider.phi`` is in rad" in st.Slider.__doc__


def test_what_one_looks_at_has_a_short_text_and_a_table_for_notebooks(slider):
    run = st.simulate(slider, "50 ms", sample_rate="10 kHz")
    base = st.Description(slider, st.Initial(), st.Settings(duration=5))
    study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "3 deg", 3), "mass": st.Values([1])})
    assert repr(study) == "<Study of 3 runs: phi (3) x mass (1)>"
    assert repr(st.Study(base=base, axes={"mass": st.Values([1])})) == "<Study of 1 run: mass (1)>"
    record = st.Record(time=np.arange(3000.0), force=np.ones(3000), normal_load="1 N")
    assert repr(record).startswith(
        "st.Record(time=<3000 values>, force=<3000 values>, normal_load="
    )
    shown = (slider, run, st.analyse(run), study)
    assert " run.duration  5 s " in words(base)
    for each in shown:
        assert len(repr(each)) < 250
        page = each._repr_html_()
        assert page.startswith("<h4>")
        assert "<table><thead>" in page
        assert "<script" not in page
    assert " 1 N " in words(record)
    stability = st.stability(slider, over="phi")
    # a sketch, small figures, and what each object's plot() draws
    for each in (slider, run, record, st.analyse(run), stability):
        assert 'src="data:image/png;base64,iVBOR' in each._repr_html_()
    assert f" {run.statistics.stick_count} " in words(run)
    assert " slider.phi  1 deg " in words(slider)
    assert " 501 samples to 50 ms: the run reached its duration. " in words(run)


def words(shown):
    """Return what a notebook shows of an object, without its tags."""
    return re.sub("<.+?>", " ", shown._repr_html_()).replace("\N{NO-BREAK SPACE}", " ")


def test_a_notebook_shows_values_as_a_file_states_them_without_the_brackets_of_python(slider):
    """A rig showed {'low': '0.5 deg', ...}, a study st.Grid(start='1 deg', ...)."""
    text = slider.to_toml().replace('"1 deg"', '{low = "0.5 deg", high = "5 deg", scale = "log"}')
    base = st.Description(slider, st.Initial(), st.Settings(duration=5))
    study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "3 deg", 3), "mass": st.Values([1])})
    test = st.protocols.DriveProgram(
        velocity="1 mm/s", program=[st.protocols.Hold("1 s"), st.protocols.Free()]
    )
    for shown, told in (
        (st.Rig.from_toml(text), "slider.phi  low = 0.5 deg, high = 5 deg, scale = log "),
        (study, "axes.phi  from = 1 deg, to = 3 deg, count = 3"),
        (study, "axes.mass  values = 1"),
        (slider.replace(drive=test), "drive.program  piece = hold, duration = 1 s; piece = free "),
    ):
        assert told in words(shown)
        assert not set("{}[]()'") & set(words(shown))


def test_a_notebook_aligns_words_at_the_left_and_numbers_at_the_right(paper_run):
    """JupyterLab puts every cell at the right that does not say its side."""
    page = st.analyse(paper_run)._repr_html_()
    assert 'style="text-align: left">largest force</td>' in page
    energy = page.split("<h4>Energy</h4>")[1]
    assert '<th style="text-align: right">work' in energy.replace("\N{NO-BREAK SPACE}", " ")
    assert "<td>" not in page
    assert "<th>" not in page


def test_a_record_without_samples_shows_itself_without_a_figure():
    """A notebook showed a traceback instead of its report."""
    record = st.Record(time=[], force=[], stiffness="1 N/mm")
    for each in (record, st.analyse(record)):
        assert each._repr_html_().startswith("<h4>")
        assert "<img" not in each._repr_html_()
        with pytest.raises(st.ResultError, match="no samples"):
            each.plot()


@pytest.mark.parametrize("room", [st, st.theory], ids=["st", "st.theory"])
def test_hints_of_public_functions_can_be_evaluated(room):
    """Tools that check arguments do so: `typing.get_type_hints(st.stability)` raised NameError."""
    functions = [each for name in dir(room) if inspect.isroutine(each := getattr(room, name))]
    assert len(functions) > 10
    for each in functions:
        if each.__module__.startswith("stiction"):
            typing.get_type_hints(each)


def test_a_finding_says_its_numbers_with_units_and_errors():
    """A tuple of floats in SI shows neither: 0.0174608 for one degree."""
    run = st.simulate(st.presets.nakano_popov_2020(), "10 s", sample_rate="2 kHz")
    found = st.analyse(run)
    phi = np.degrees(found.misalignment.phi)
    said = re.fullmatch(
        r"<Misalignment: (\S+) ± (\S+) deg, F_0 = (\S+) ± (\S+) N>", repr(found.misalignment)
    )
    assert abs(float(said[1]) - phi) <= 0.5 * float(said[2])
    assert abs(float(said[3]) - found.misalignment.F_0) <= 0.5 * float(said[4])
    assert (
        repr(found.regime) == f"<Regime: stick-slip with confidence {found.regime.confidence:.2f}>"
    )
    said = re.search(r"static (\S+) ± \S+ N, coefficient (\S+) ±", repr(found.friction))
    assert float(said[1]) == pytest.approx(found.friction.static.force, rel=1e-4)
    assert float(said[2]) == pytest.approx(found.friction.static.coefficient, rel=1e-4)
    assert repr(found.divergence).startswith("<Divergence: exponent 0.5 ±")
    critical = st.linear_stability.critical(run.slider, "phi")
    ends = ", ".join(f"{np.degrees(each):.4g} deg" for each in critical.values)
    assert repr(critical) == f"<Critical phi: {ends}; sliding is unstable, stable, unstable>"


def test_what_a_finding_does_not_know_is_not_a_number():
    steady = st.simulate(st.presets.nakano_popov_2020().replace(phi="20 deg"), "4 s")
    said = repr(st.analyse(steady).friction)
    assert "static unknown" in said
    assert "nan" not in said
