"""A law of the user's own, in a file that a description names: read, stored, and read back."""

import inspect
import json
import math
import os
import pickle
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from tests.waiting import PATIENCE

import stiction as st
from stiction.cli import main
from stiction.errors import echo
from stiction.friction import has_state
from stiction.friction.user.derivative import jump
from stiction.friction.user.validation import printing
from stiction.own_code.source import excerpt, raised_in_law
from stiction.study.execution import sweep
from stiction.study.store.store import ERROR

LAW = """
from typing import NamedTuple
from numba import njit
from stiction.text.units import PositiveSpeed

with open("ran", "a") as file:  # what running this text leaves behind
    file.write("x")

@njit
def ratio(v, v_h):
    return 1.0 + v / v_h

class Mine(NamedTuple):
    mu_0: float
    v_h: PositiveSpeed = 0.05

    def coefficient(law, v):
        return law.mu_0 / ratio(v, law.v_h)

    def slope(law, v):
        return -law.mu_0 / law.v_h / ratio(v, law.v_h) ** 2
"""
TABLE = """
[slider]
mass = "0.25 kg"
k_x = "1 kN/m"
k_y = "10 MN/m"
phi = "1 deg"
normal_load = "10 N"
[friction]
law = "mylaw.py:Mine"
mu_0 = 0.2
v_h = "50 mm/s"
[drive]
velocity = "1 mm/s"
[run]
duration = "50 ms"
sample_rate = "10 kHz"
"""


@pytest.fixture
def config(tmp_path, monkeypatch):
    """A description beside its law, in another folder than the working one."""
    (tmp_path / "working").mkdir()
    monkeypatch.chdir(tmp_path / "working")
    (tmp_path / "mylaw.py").write_text(LAW)
    (tmp_path / "a.toml").write_text(TABLE)
    yield tmp_path / "a.toml"
    forget_laws()


def forget_laws():
    """Take every law out of this process, as in a new one."""
    for name in [name for name in sys.modules if name.startswith("stiction_law_")]:
        del sys.modules[name]


def python(code, cwd, **environment):
    """Run Python in a process of its own; return what it prints."""
    done = subprocess.run(
        [sys.executable, *([code] if code.endswith(".py") else ["-c", code])],
        cwd=cwd,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def simulate_file(config):
    from stiction.simulation import run

    return run(st.Description.from_toml(config))


def test_a_description_names_a_file_and_a_class(config):
    run = simulate_file(config)
    law = run.slider.law
    assert type(law).__name__ == "Mine"
    assert law == (0.2, 0.05)
    builtin = run.slider.replace(friction=st.laws.HyperbolicWeakening(mu_0=0.2, v_h=0.05))
    same = st.simulate(builtin, 0.05, sample_rate=1e4)
    # the slope is rounded otherwise; a step is kept to 2e-5
    assert run.stick_intervals == pytest.approx(same.stick_intervals, rel=1e-9, abs=1e-9)
    assert st.Slider.from_toml(config) == run.slider


def test_a_law_s_file_has_a_mebibyte_at_most(config):
    law, room = config.parent / "mylaw.py", 2**20 - len(LAW)
    law.write_text(LAW + "#" * room)
    assert st.Slider.from_toml(config).law == (0.2, 0.05)
    law.write_text(LAW + "#" * (room + 1))
    with pytest.raises(st.DescriptionError, match="has more than 1048576 bytes"):
        st.Slider.from_toml(config)


def test_an_excerpt_has_the_decorators_of_what_it_defines():
    needed = "from mine import mark\n@mark\n@mark(2)\nclass Mine:\n    mu_0 = 0.2"
    assert excerpt(needed.replace("\n@", "\nx = 1\n@", 1) + "\nprint(x)", "Mine") == needed


@pytest.mark.parametrize(
    "to", ["../working/mylaw.py", "{working}/mylaw.py", "link.py", "linked/mylaw.py"]
)
def test_a_law_lies_in_the_folder_of_its_description(config, to):
    """Not where its writer chose a path to, nor in the working folder, nor behind a link."""
    folder, working = config.parent / "of", config.parent / "working"
    folder.mkdir()
    (working / "mylaw.py").write_text(LAW)
    (folder / "link.py").symlink_to(working / "mylaw.py")
    (folder / "linked").symlink_to(working)
    text = TABLE.replace("mylaw.py", to.format(working=working))
    (folder / "a.toml").write_text(text)
    with pytest.raises(st.DescriptionError, match=r"lies outside .* allow it: trust=True$"):
        st.Description.from_toml(folder / "a.toml")
    assert not (working / "ran").exists()
    allowed = st.Description.from_toml(folder / "a.toml", trust=True)
    assert allowed.slider.law == (0.2, 0.05)
    (folder / "a.toml").write_text(TABLE)
    with pytest.raises(st.DescriptionError, match=r"no file 'mylaw.py' in .*of"):
        st.Description.from_toml(folder / "a.toml")


def test_a_law_is_not_run_before_all_else_is_right(config):
    folder = config.parent / "working"
    surface = TABLE.replace("v_h =", "anisotropy = { ratio = -1 }\nv_h =")
    wrong = [TABLE.replace("0.25 kg", "-0.25 kg"), TABLE.replace("50 ms", "50 m"), TABLE + "[x]\n"]
    wrong = [(st.Description, text) for text in (*wrong, surface)]
    wrong += [(st.Study, TABLE + "[axes.masss]\nvalues = [1, 2]\n")]
    wrong += [(st.Rig, TABLE.replace("1 deg", "1 +- 0 deg"))]
    for kind, text in wrong:
        config.write_text(text)
        with pytest.raises(st.DescriptionError) as error:
            kind.from_toml(config)
        assert len(error.value.faults) == 1
    study = "[study]\nmeasures = ['pig']\nseed = -1\n[axes.phi]\nfrom = '1 deg'\ncount = 0\n"
    config.write_text(TABLE.replace("0.25 kg", "-0.25 kg") + study)
    with pytest.raises(st.DescriptionError) as error:
        st.Study.from_toml(config)
    assert [fault.path for fault in error.value.faults] == [
        *("axes.phi.to", "axes.phi.count", "study.measures", "study.seed", "slider.mass")
    ]
    assert not (folder / "ran").exists()
    config.write_text(TABLE)
    st.Slider.from_toml(config)
    assert (folder / "ran").exists()


@pytest.mark.parametrize(
    ("old", "new", "path", "words"),
    [
        ("mylaw.py:Mine", "none.py:Mine", "law", "no file 'none.py' in "),
        ("mylaw.py:Mine", "mylaw.py:", "law", "write 'mylaw.py:MyLaw'"),
        ("mylaw.py:Mine", "mylaw.py:Mein", "law", "did you mean 'Mine'"),
        ("mylaw.py:Mine", "mylaw.py:ratio", "law", "is not a NamedTuple; write class ratio("),
        ("mu_0 = 0.2", "mu_O = 0.2", "mu_0", "missing"),
        ("mu_0 = 0.2", "mu_O = 0.2", "mu_O", "did you mean 'mu_0'"),
        ("mu_0 = 0.2", 'mu_0 = "0.2"', "mu_0", "'0.2' is not a number"),
        ("mu_0 = 0.2", "mu_0 = true", "mu_0", "True is not a number"),
        ('v_h = "50 mm/s"', 'v_h = "50 mm"', "v_h", "not a unit of a velocity"),
        ("mu_0 = 0.2", "source = 1\nmu_0 = 0.2", "source", "must be text"),
    ],
)
def test_faults_of_the_description(config, old, new, path, words):
    config.write_text(TABLE.replace(old, new))
    with pytest.raises(st.DescriptionError) as error:
        st.Description.from_toml(config)
    found = {fault.path: fault.message for fault in error.value.faults}
    assert words in found[f"friction.{path}"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("from numba", "from nunba", "cannot be run: ModuleNotFoundError: No module named"),
        ("class Mine", "class Mine Mine", "cannot be run: SyntaxError"),
        ("@njit", "import sys; sys.exit(3)", "cannot be run: SystemExit: 3"),
        ("@njit", "raise BaseException('no')", "cannot be run: BaseException: no"),
        ("mu_0 / ratio", "mu_0.exit() / ratio", "raises AttributeError"),
        ("return law.mu_0", "raise GeneratorExit; return law.mu_0", "raises GeneratorExit"),
        ("mu_0: float", "mu_0: 'Flot'", "Mine' cannot be made: NameError: name 'Flot'"),
        ("def slope", "def slop", "is not a friction law, it lacks slope; write class Mine("),
        ("mu_0 / ratio", "nu / ratio", "raises AttributeError"),
        ("mu_0 / ratio", "mu_0 / v / ratio", "raises ZeroDivisionError"),
        ("mu_0 / ratio", "mu_0 * float('nan') / ratio", "is nan; it must be finite"),
        ("return law.mu_0", "return -law.mu_0", "is -0.2; it must not be negative"),
        ("return -law.mu_0", "return law.mu_0", "there its coefficient changes by -4 s/m"),
        ("/ law.v_h / ratio", "/ ratio", "is -0.2 s/m, but there its coefficient changes by -4"),
        ("mu_0", "law", "has a parameter 'law'"),
        ("def slope(law, v)", "def states()", "it lacks settled, force, change; write"),
    ],
)
def test_faults_of_the_file(config, old, new, words):
    (config.parent / "mylaw.py").write_text(LAW.replace(old, new))
    with pytest.raises(st.DescriptionError) as error:
        st.Description.from_toml(config)
    assert words in str(error.value)
    assert "friction" in str(error.value)
    assert "\n" not in words


class Table(NamedTuple):
    """Friction of a list, or of a tuple, or with the sign of its slope turned."""

    values: list[float] | tuple[float, ...]
    way: float = -1.0

    def coefficient(law, v):
        return law.values[0] + law.values[1] * math.exp(-v / 0.05)

    def slope(law, v):
        return law.way * law.values[1] * math.exp(-v / 0.05) / 0.05


class Falling(NamedTuple):
    """Friction that falls below zero beyond a speed."""

    mu_0: float
    end: float

    def coefficient(law, v):
        return law.mu_0 * (1.0 - v / law.end)

    def slope(law, v):
        return -law.mu_0 / law.end


class Dipping(NamedTuple):
    """Friction by a parabola through few measured speeds, which is lowest at a speed."""

    mu_0: float
    lowest: float
    at: float

    def coefficient(law, v):
        return law.lowest + (law.mu_0 - law.lowest) * (1.0 - v / law.at) ** 2

    def slope(law, v):
        return -2.0 * (law.mu_0 - law.lowest) * (1.0 - v / law.at) / law.at


class Jumping(NamedTuple):
    """Friction that falls at a speed, within a range of it."""

    at: float
    range: float
    fall: float = 0.1

    def coefficient(law, v):
        share = min(max((v - law.at) / law.range, 0.0), 1.0) if law.range else float(v > law.at)
        return 0.3 - law.fall * share

    def slope(law, v):
        return -law.fall / law.range if 0.0 <= v - law.at < law.range else 0.0


class Vanishing(NamedTuple):
    """Friction that decays to nothing, and falls at `v_f` by a step."""

    v_f: float
    step: float = 0.0

    def coefficient(law, v):
        return 0.3 * math.exp(-v / law.v_f) + (law.step if v < law.v_f else 0.0)

    def slope(law, v):
        return -0.3 / law.v_f * math.exp(-v / law.v_f)


@pytest.mark.parametrize(("end", "v"), [(2e-3, "0.00237137"), (5.0, "5.62341")])
def test_friction_that_is_negative_at_any_speed_is_refused(slider, end, v):
    """Beyond 1 mm/s it was not seen, and such runs ended as completed."""
    with pytest.raises(st.DescriptionError, match=rf"coefficient\(law, {v}\) of 'Falling' is -"):
        slider.replace(friction=Falling(0.2, end))
    assert slider.replace(friction=Falling(0.2, 20.0))


def test_friction_that_is_negative_between_two_decades_is_refused(slider):
    """From 0.2 to 0.5 m/s: it was looked for at 0.1 and 1 m/s only."""
    with pytest.raises(
        st.DescriptionError, match=r"coefficient\(law, 0.237137\) of 'Dipping' is -"
    ):
        slider.replace(friction=Dipping(0.3, -0.05, 0.33))
    assert slider.replace(friction=Dipping(0.3, 0.05, 0.33))


@pytest.mark.parametrize("at", [2e-9, 3.21e-3, 5.0])
def test_friction_that_jumps_between_two_speeds_of_slip_is_refused(slider, at):
    """Steps over a jump are accepted: such runs were off by a third of the force."""
    told = rf"coefficient\(law, {at:g}\) of 'Jumping' jumps there from 0.3 to 0.2; smooth the jump"
    with pytest.raises(st.DescriptionError, match=told):
        slider.replace(friction=Jumping(at, 0.0))
    for range in (1e-6 * at, 1e-3 * at, at):
        assert slider.replace(friction=Jumping(at, range))
    assert slider.replace(friction=Jumping(0.0, 0.0))  # a static coefficient


@pytest.mark.parametrize(("height", "found"), [(1.1, True), (0.9, False)])
def test_a_jump_is_one_from_the_stated_size_on(height, found):
    steps = jump(lambda v: 1e-3 * height * (v > 1.3), lambda v: 0.0, 1.0, 2.0, 1e-3)
    assert (steps is not None) == found
    if steps is not None:
        assert steps == (np.nextafter(1.3, 2.0), 0.0, 1e-3 * height)


@pytest.mark.parametrize("law", [Jumping(0.0, 0.0113, 0.3), Vanishing(1e-3), Vanishing(1e-2)])
def test_friction_that_falls_to_nothing_does_not_jump(slider, law):
    """Any change was more than a share of nothing: the law was refused, from 7e-45 to 7e-45."""
    assert slider.replace(friction=law)


def test_friction_that_jumps_where_it_falls_steeply_is_refused(slider):
    """Beside it friction changes thirty times as much, as its slope tells."""
    with pytest.raises(st.DescriptionError, match=r"0.01\) of 'Vanishing' jumps there from 0.11"):
        slider.replace(friction=Vanishing(1e-2, 1e-3))


class Rooted(NamedTuple):
    """Friction that changes as a power of the speed, and falls by default."""

    power: float
    change: float = -0.01

    def coefficient(law, v):
        return 0.3 + law.change * v**law.power

    def slope(law, v):
        return law.change * law.power * max(v, 1e-30) ** (law.power - 1.0)


@pytest.mark.parametrize("power", [0.1, 0.5, 0.75])
def test_friction_that_falls_infinitely_fast_from_rest_is_refused(slider, power):
    """A run with it took 50 s to reach max_steps."""
    with pytest.raises(st.DescriptionError, match="falls infinitely fast from rest"):
        slider.replace(friction=Rooted(power))
    assert slider.replace(friction=Rooted(1.0))


def test_friction_that_rises_as_a_root_is_not_refused(slider):
    """That of a grease (Herschel and Bulkley) does; it slides at k_x u_x = mu(V) W cos(phi)."""
    run = st.simulate(slider.replace(friction=Rooted(0.5, 0.1)), "5 s")
    wanted = Rooted(0.5, 0.1).coefficient(1e-3) * slider.normal_load * math.cos(slider.misalignment)
    assert slider.k_x * run.samples["u_x"][-1] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("of", [lambda law: law, lambda law: st.laws.Anisotropic(law, ratio=1.5)])
def test_a_law_made_in_python_is_checked_as_one_from_a_file(slider, of):
    """A list ended runs with "unhashable type"; with the slope's sign turned they were wrong."""
    assert slider.replace(friction=of(Table((0.1, 0.1)))).law == of(Table((0.1, 0.1)))
    for law, words in (
        (Table([0.1, 0.1]), "values of 'Table' is a list"),
        (Table((0.1, 0.1), way=1.0), r"slope\(law, 1.3e-06\) of 'Table' is 2 s/m.*by -2 s/m"),
        (Table((-0.3, 0.2)), r"coefficient\(law, 0\) of 'Table' is -0.1; it must not"),
    ):
        with pytest.raises(st.DescriptionError, match=words):
            slider.replace(friction=of(law))


class Plain:
    def coefficient(law, v):
        return 0.2

    def slope(law, v):
        return 0.0


@dataclass(frozen=True)
class Data(Plain):
    mu: float = 0.2


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (Plain(), r"write class Plain\(NamedTuple\) with its parameters as fields and the methods"),
        (Plain, r"write class Plain\(NamedTuple\)"),
        (Data(), r"write class Data\(NamedTuple\)"),
        (lambda v: 0.2, r"write class MyLaw\(NamedTuple\)"),
        (echo, r"write class echo\(NamedTuple\)"),
        (Falling, r"make one with the values of its fields, Falling\(\.\.\.\)"),
        (0.2, r"write for example st\.Coulomb\(mu_0=0\.2\)"),
    ],
)
def test_what_is_not_a_law_is_told_how_to_write_one(slider, law, words):
    with pytest.raises(st.DescriptionError, match=f"is not a friction law; {words}"):
        slider.replace(friction=law)


def test_the_example_describes_what_its_script_runs():
    folder = Path(__file__).parents[3] / "examples"
    description = st.Description.from_toml(folder / "own_law.toml")
    assert description.slider.law == (0.2, 0.01, 1e-4)
    assert description.run == st.Settings(duration=5.0, sample_rate=1e3)


def test_a_law_with_state_is_found(config):
    """As of rate and state, its coefficient in steady sliding may be infinite at rest."""
    (config.parent / "mylaw.py").write_text("""
from math import log
from typing import NamedTuple
class Mine(NamedTuple):
    mu_0: float
    v_h: float
    @staticmethod
    def states(): return (("z", "m", "bristle"),)
    def coefficient(law, v): return law.mu_0 + 0.01 * log(v)
    def settled(law, speed): return (0.0,)
    def force(law, slip, load, state): return (0.0, 0.0)
    def change(law, slip, load, state): return (0.0,)
""")
    config.write_text(TABLE.replace('"50 mm/s"', "0.05"))
    assert has_state(st.Slider.from_toml(config).law)


ENDLESS = [
    (
        "return law.mu_0 / ratio",
        "while True:\n            pass\n        return ratio",
        "coefficient at 0",
    ),
    ("return -law", "while v != v:\n            pass\n        return -law", "slope at nan"),
    ("return 1.0 + v", "while v == 1.0:\n        v += 0.0\n    return 1.0 + v", "coefficient at 1"),
]


@pytest.mark.parametrize(("old", "new", "words"), ENDLESS)
def test_a_law_that_does_not_end_is_told(config, old, new, words):
    (config.parent / "mylaw.py").write_text(LAW.replace(old, new))
    with pytest.raises(st.DescriptionError, match=rf"{words} m/s ran 100,000 lines.*range\(50\)"):
        st.Description.from_toml(config)


class Text(NamedTuple):
    mu_0: float

    def coefficient(law, v):
        return "0.3"

    def slope(law, v):
        return 0.0


class Pair(Text):
    def coefficient(law, v):
        return (0.3, v)


class Nothing(Text):
    def coefficient(law, v):
        return 0.3

    def slope(law, v):
        pass


class Long(Text):
    def coefficient(law, v):
        return 10**400


RETURNS = [
    (Long, f"coefficient(law, 0) of 'Long' is {echo(10**400)}; it must be one number"),
    (Text, "coefficient(law, 0) of 'Text' is '0.3'; it must be one number"),
    (Pair, "coefficient(law, 0) of 'Pair' is (0.3, 0.0); it must be one number"),
    (Nothing, "slope(law, 0) of 'Nothing' is None; it must be one number"),
]


@pytest.mark.parametrize(("kind", "words"), RETURNS)
def test_a_law_that_returns_no_number_is_told(slider, kind, words):
    """A text in digits, or two numbers, ended in a traceback."""
    law = kind(0.3)
    with pytest.raises(st.DescriptionError) as error:
        slider.replace(friction=law)
    assert error.value.faults[0].message == words
    with pytest.raises(st.DescriptionError) as error:
        st.testing.check_law(law)
    assert words in str(error.value)


@pytest.mark.parametrize("where", ["return law.mu_0 / ratio", "return 1.0 + v"])
def test_a_law_that_prints_is_told(config, where):
    """Compiled, such a run did not end: neither when it prints, nor when what it calls does."""
    (config.parent / "mylaw.py").write_text(LAW.replace(where, f"print(v); {where}"))
    name = {"return 1.0 + v": "ratio"}.get(where, "coefficient")
    with pytest.raises(st.DescriptionError, match=f"{name} prints.*take print out"):
        st.Description.from_toml(config)


class Printing(Text):
    def coefficient(law, v):
        print(v)
        return 0.3


class PrintingToo(Printing):
    """It inherits the method that prints."""


class Silent(Printing):
    """It has one of its own in its place."""

    def coefficient(law, v):
        return 0.3


class Endless(Silent):
    def slope(law, v):
        while True:
            v += 1.0


class EndlessToo(Endless):
    """It inherits the method that does not end."""


@pytest.mark.parametrize(
    ("kind", "words"),
    [(PrintingToo, "coefficient prints"), (EndlessToo, "slope at 0 m/s ran 100,000 lines")],
)
def test_inherited_methods_are_checked_like_own_ones(slider, kind, words):
    """Of a law that inherits them, no method was looked at: the check itself did not end."""
    with pytest.raises(st.DescriptionError, match=words):
        slider.replace(friction=kind(0.3))
    assert slider.replace(friction=Silent(0.3)).law == Silent(0.3)


RECURSIVE = """
@njit
def ratio(v, v_h):
    return 1.0 + v / v_h if v < 100.0 else ratio(50.0, v_h)
"""


def test_a_function_that_calls_itself_does_not_print(config):
    law = config.parent / "mylaw.py"
    begin, end = (LAW.index(mark) for mark in ("@njit", "class "))
    law.write_text(LAW[:begin] + RECURSIVE.lstrip() + "\n\n" + LAW[end:])
    assert printing(type(st.Description.from_toml(config).slider.law)) == ""


class Looping(NamedTuple):
    mu_0: float

    @staticmethod
    def states():
        return (("z", "m", "bristle"),)

    def coefficient(law, v):
        return law.mu_0

    def settled(law, speed):
        return (0.0,)

    def force(law, slip, load, state):
        return (law.mu_0 * load, 0.0)

    def change(law, slip, load, state):
        z = 1.0
        while slip[0] == 0.0 and z > 0.0:
            z = 0.5 * z + 1.0
        return (z,)


def test_a_slider_takes_no_law_that_does_not_end(slider):
    """Neither a law with states, nor a set-valued one: it ran for ever."""

    class Turning(NamedTuple):
        mu_0: float

        def coefficient(law, v):
            while v > 0.5:
                pass
            return law.mu_0

        def slope(law, v):
            return 0.0

    for law in (Turning(0.2), Looping(0.2)):
        with pytest.raises(st.DescriptionError, match=r"ran 100,000 lines.*range\(50\)"):
            slider.replace(friction=law)


class Bound(Looping):
    """A law whose states are those of an object, not of its class."""

    def states(self):
        return (("z", "m", "bristle"),)


def test_states_of_an_object_are_refused_before_a_run(slider):
    """It said that `Bound.states() missing 1 required positional argument`, as the run began."""
    with pytest.raises(st.DescriptionError, match=r"states\(\) takes no argument.*@staticmethod"):
        slider.replace(friction=Bound(0.2))
    with pytest.raises(st.DescriptionError, match="@staticmethod"):
        st.testing.check_law(Bound(0.2))


class Making(NamedTuple):
    """Exponential weakening, summed in arrays that its methods make."""

    mu_0: float
    mu_inf: float
    v_f: float

    def coefficient(law, v):
        return np.sum(np.array([law.mu_inf, (law.mu_0 - law.mu_inf) * np.exp(-v / law.v_f)]))

    def slope(law, v):
        return np.sum(np.array([(law.mu_inf - law.mu_0) / law.v_f * np.exp(-v / law.v_f), 0.0]))


@pytest.mark.parametrize("how", [{}, {"regularisation": "10 um/s"}], ids=["set-valued", "smooth"])
def test_a_law_may_make_arrays(slider, how):
    settings = {"sample_rate": "1 kHz", "multiscale": False, **how}
    own = slider.replace(friction=Making(*slider.law[:3]))
    found, wanted = (st.simulate(each, 0.05, **settings) for each in (own, slider))
    np.testing.assert_allclose(found.data["u_x"], wanted.data["u_x"], rtol=1e-9)


def test_check_law_tells_what_does_not_end():
    with pytest.raises(st.DescriptionError, match="Looping: change at 0 m/s ran 100,000 lines"):
        st.testing.check_law(Looping(0.2))


def test_a_trial_of_a_law_leaves_no_trace(config):
    before = sys.gettrace()
    law = st.Slider.from_toml(config).law
    assert sys.gettrace() is before
    assert hasattr(type(law).coefficient.__globals__["ratio"], "py_func")  # compiled, as it was


def test_what_cannot_be_compiled_is_told_in_a_line(config):
    (config.parent / "mylaw.py").write_text(LAW.replace("@njit", ""))
    with pytest.raises(st.DescriptionError) as error:
        simulate_file(config)
    first, _ = map(str, error.value.faults)
    assert first.startswith("friction: coefficient cannot be compiled: Untyped global name 'ratio'")
    assert "numba.njit" in first


def test_an_import_in_a_method_is_told_in_a_line(config):
    """It ended in a traceback: this error of numba is no NumbaError."""
    line = "return law.mu_0 / ratio"
    (config.parent / "mylaw.py").write_text(LAW.replace(line, f"import math; {line}"))
    with pytest.raises(st.DescriptionError, match="coefficient cannot be compiled: Use of unsupp"):
        simulate_file(config)


# --- kept and read back -------------------------------------------------------------------------


def test_back_in_the_same_process(config, tmp_path):
    run = simulate_file(config)
    again = st.Description.from_json(run.description.to_json())
    assert again == run.description
    assert type(again.slider.law) is type(run.slider.law)
    assert st.Description.from_dict(run.description.to_dict()) == run.description
    kept = run.description.to_dict()["friction"]
    text = {"law": "mylaw.py:Mine", "source": LAW, "reads": {}}
    assert kept == {**text, "mu_0": 0.2, "v_h": 0.05}
    (tmp_path / "mylaw.py").unlink()
    back = st.load(run.save(tmp_path / "a.nc"))  # this process knows the law
    assert type(back.slider.law) is type(run.slider.law)
    law = pickle.loads(pickle.dumps(run.slider.law))
    assert type(law) is type(run.slider.law)


LOAD = "import stiction as st; print(st.load({path!r}{trust}).slider.law)"
REFUSED = """
import stiction as st
try:
    st.load({path!r})
except st.ResultError as error:
    print(error)
"""


def test_another_process_runs_nothing(config, tmp_path):
    path = str(simulate_file(config).save(tmp_path / "a.nc"))
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    # the same text beside the result, and in the working folder: the sender may have put it there
    (elsewhere / "mylaw.py").write_text(LAW)
    said = python(REFUSED.format(path=path), elsewhere)
    assert "friction.law: 'mylaw.py:Mine' is a user's law" in said
    assert "trust=True" in said
    assert not (elsewhere / "ran").exists()  # nothing was run
    # a module that was imported from the same text is the user's own choice
    assert "Mine(mu_0=0.2" in python("import mylaw; " + LOAD.format(path=path, trust=""), elsewhere)
    (elsewhere / "ran").unlink()
    (elsewhere / "mylaw.py").write_text(LAW + "# edited\n")
    assert "trust=True" in python("import mylaw" + REFUSED.format(path=path), elsewhere)
    (elsewhere / "mylaw.py").unlink()
    (elsewhere / "ran").unlink()
    assert "Mine(mu_0=0.2" in python(LOAD.format(path=path, trust=", trust=True"), elsewhere)
    assert (elsewhere / "ran").exists()
    # what was computed can be read anyway
    with xr.open_dataset(path, engine="h5netcdf") as data:
        assert json.loads(data.attrs["description"])["friction"]["source"] == LAW


def test_a_result_without_the_text_runs_no_file(config, tmp_path):
    """A result that names a file, but does not hold its text, has nothing run."""
    run = simulate_file(config)
    table = run.description.to_dict()
    del table["friction"]["source"]
    (tmp_path / "other.py").write_text(LAW + "# another\n")
    table["friction"]["law"] = "other.py:Mine"
    run.data.attrs["description"] = json.dumps(table)
    run.save(tmp_path / "a.nc")
    for trust in (False, True):
        with pytest.raises(st.ResultError, match="was not stored"):
            st.load(tmp_path / "a.nc", trust=trust)
    assert not [name for name in sys.modules if name.startswith("stiction_law_other")]


def test_a_result_names_no_class_but_a_law(config):
    """Texts of modules that every process has loaded are known to all."""
    table = st.Description.from_toml(config).to_dict()
    ran = config.parent / "working" / "popped"
    command = {"args": ["touch", str(ran)], "source": inspect.getsource(subprocess)}
    table["friction"] = {"law": "subprocess.py:Popen", **command}
    with pytest.raises(st.DescriptionError, match=r"'subprocess.py:Popen' is not a NamedTuple"):
        st.Description.from_json(json.dumps(table))
    assert not ran.exists()


SCRIPT = """
from math import exp
from typing import NamedTuple
import stiction as st

SCALE = 0.1
def unused(): return 1

class Mine(NamedTuple):
    mu: float
    def coefficient(law, v): return law.mu * (1 + SCALE * exp(-v))
    def slope(law, v): return -SCALE * law.mu * exp(-v)

with open("ran", "a") as file:
    file.write("x")
slider = st.presets.nakano_popov_2020().replace(friction=Mine(0.2))
description = st.Description(slider, st.Initial(), st.Settings(duration=1.0))
with open("script.json", "w") as file:
    file.write(description.to_json())
print(st.Description.from_json(description.to_json()).slider.law)
"""
READ = """
import stiction as st
text = open("script.json").read()
try:
    print(st.Description.from_json(text))
except st.DescriptionError as error:
    print(error)
print(st.Description.from_json(text, trust=True).slider.law)
"""


def test_a_law_in_a_script_is_kept_without_its_runs(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    assert "Mine(mu=0.2)" in python("script.py", tmp_path)
    refused, trusted = python(READ, tmp_path).splitlines()
    assert "'script.py:Mine' is a user's law" in refused
    assert trusted == "Mine(mu=0.2)"
    assert (tmp_path / "ran").read_text() == "x"  # the script ran once
    text = json.loads((tmp_path / "script.json").read_text())["friction"]["source"]
    assert "class Mine" in text
    assert "SCALE = 0.1" in text
    assert "unused" not in text
    assert "replace" not in text


def test_a_file_edited_after_its_import_is_not_taken_for_what_ran(tmp_path, monkeypatch):
    """Neither kept with the result, nor as the name of machine code."""
    from stiction.own_code.source import text_of
    from stiction.solver.compilation.pointer import _source

    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "edited_law.py"
    path.write_text(LAW)
    import edited_law

    assert text_of(edited_law.Mine) == ("edited_law.py", LAW)
    assert _source(edited_law.Mine) == f"edited_law\n{LAW}"
    path.write_text(LAW.replace("-law.mu_0", "-2 * law.mu_0"))
    assert text_of(edited_law.Mine) is None
    with pytest.raises(OSError, match="as it was run"):
        _source(edited_law.Mine)


def test_a_law_in_a_prompt_has_no_text(tmp_path):
    python(SCRIPT.replace("print(st.Description", "#"), tmp_path)
    with pytest.raises(st.DescriptionError, match="'__main__:Mine' was not stored"):
        st.Description.from_json((tmp_path / "script.json").read_text(), trust=True)


def test_machine_code_is_kept_for_the_next_process(config, tmp_path, code_cache):
    cache = {"NUMBA_CACHE_DIR": str(code_cache)}
    code = f"""
import pickle, stiction as st
from stiction.simulation import run
d = st.Description.from_toml({str(config)!r})
print(run(d).stick_intervals[0, 1])
open("law.pickle", "wb").write(pickle.dumps(d.slider))
"""
    one = python(code, tmp_path, **cache)
    kept = sorted(code_cache.rglob("*.code"))
    stamps = [each.stat().st_mtime_ns for each in kept]
    assert sum("coefficient_and_slope_at" in each.name for each in kept) == 1
    assert python(code, tmp_path, **cache) == one
    assert sorted(code_cache.rglob("*.code")) == kept
    assert [each.stat().st_mtime_ns for each in kept] == stamps
    # another process makes the law of its pickle, as a pool of processes needs
    load = "import pickle; print(pickle.load(open('law.pickle', 'rb')).law)"
    assert "Mine(mu_0=0.2" in python(load, tmp_path, **cache)


@pytest.mark.parametrize("raised", ["ValueError('no')", "BaseException('no')", "SystemExit(0)"])
def test_what_a_law_raises_later_is_told_in_a_line(config, raised, capsys):
    """Not in a traceback: it is the law that is to be corrected."""
    right = "return law.mu_0 / ratio(v, law.v_h)"
    law = LAW.replace(right, f"if v > 2e-3: raise {raised}\n        {right}")
    (config.parent / "mylaw.py").write_text(law)
    with pytest.raises(SystemExit) as end:
        main(["stability", str(config), "--set", "V=3mm/s"])
    assert end.value.code == 2
    said = capsys.readouterr().err
    assert f"mylaw.py, line 18: {raised.partition('(')[0]}: " in said
    assert "Traceback" not in said


def test_a_study_says_where_a_law_raised(config, monkeypatch):
    """It said what, and not where, as `stiction run` does."""
    right = "return law.mu_0 / ratio(v, law.v_h)"
    law = LAW.replace(right, f"if v > 2e-3: raise ValueError('no')\n        {right}")
    (config.parent / "mylaw.py").write_text(law)
    base = st.Description.from_toml(config)
    study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "2 deg", 2)}, measures=["peak_force"])
    monkeypatch.setattr(sweep, "observe_run", lambda one, *_: one.slider.law.coefficient(3e-3))
    outcome = sweep.run_one(study, (), (0,), lambda: False)
    told = f"{config.parent / 'mylaw.py'}, line 18: ValueError: no; correct it there"
    assert (outcome.status, outcome.message) == (ERROR, told)


@pytest.mark.parametrize("file", ["mylaw.py", "/elsewhere/mylaw.py", "<mylaw.py>", "other.py"])
def test_machine_code_of_a_law_may_come_from_another_folder(config, file):
    """Of a copy of a law, `stiction run` showed a traceback: the code named the first file."""
    st.Description.from_toml(config)
    with pytest.raises(ValueError, match="no") as error:
        exec(compile("raise ValueError('no')", file, "exec"), {})
    place = None if file == "other.py" else f"{config.parent / 'mylaw.py'}, line 1"
    assert raised_in_law(error.value) == (place and f"{place}: ValueError: no; correct it there")


def test_the_command_line(config, tmp_path, capsys):
    def inside(*arguments):
        with pytest.raises(SystemExit) as end:
            main([str(argument) for argument in arguments])
        return int(end.value.code or 0)

    assert inside("run", config, "--output", tmp_path / "a.nc") == 0
    assert inside("plot", tmp_path / "a.nc", "--output", tmp_path / "a.svg") == 0
    (tmp_path / "mylaw.py").unlink()
    forget_laws()
    capsys.readouterr()
    assert inside("plot", tmp_path / "a.nc", "--output", tmp_path / "b.png") == 2
    assert "trust the source, allow it: --trust; in Python" in capsys.readouterr().err
    assert not (tmp_path / "b.png").exists()
    assert inside("plot", tmp_path / "a.nc", "--output", tmp_path / "b.png", "--trust") == 0
