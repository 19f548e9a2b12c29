"""What an audit says of springs in series, against NumPy and simulations of a single spring."""

from dataclasses import replace
from math import inf, isinf, pi

import numpy as np
import pytest
from scipy.linalg import eigh

import stiction as st
from stiction.auditing.advice import further
from stiction.auditing.chain import SMALL, axis, examine, parts, softest_path, yield_of_mass
from stiction.auditing.words.chain import chain_sections, masses
from stiction.auditing.words.changes import name_of
from stiction.auditing.words.verdict import final_motion
from stiction.system.tensors import principal

PAPER = st.presets.nakano_popov_2020()
CHAIN = PAPER.replace(
    springs=[
        st.Spring("load cell", k_x="20 kN/m", k_y="rigid", angle="2 deg", mass="1 g"),
        st.Spring("drive", k_x="50 kN/m", k_y="5 MN/m", mass="1 g"),
        st.Spring("leaf springs", k_x="1.2 kN/m", k_y="30 MN/m"),
    ],
    drive=st.ConstantVelocity("20 mm/s"),
    phi="4 deg",
)


@pytest.fixture(scope="module")
def found():
    return st.audit(CHAIN)


def stiffness(zero, springs):
    """Return the stiffness tensor of springs in axes at an angle, by inverses of inverses."""
    total = np.zeros((2, 2))
    for each in springs:
        a = each.angle - zero
        Q = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        total += Q @ np.diag([1.0 / each.k_x, 1.0 / each.k_y]) @ Q.T
    return np.linalg.inv(total)


def single(slider, springs):
    """Return the slider on one spring with the principal values of that tensor."""
    # in the axes X and Y
    values, vectors = np.linalg.eigh(stiffness(slider.phi, springs))
    x = vectors[:, 0]
    phi = -np.arctan(x[1] / x[0])
    return slider.replace(springs=(), k_x=values[0], k_y=values[1], phi=f"{float(phi)!r} rad")


def test_shares_are_of_what_each_axis_yields(found):
    chain = found.chain
    total = np.linalg.inv(stiffness(CHAIN.turn, CHAIN.springs))
    assert abs(total[0, 1]) < 1e-9 * total[1, 1]
    # a part made ten thousandth softer: what it adds to the compliance is its share
    for place, part in enumerate(chain.parts):
        spring = part.spring._replace(k_x=part.spring.k_x / 1.0001, k_y=part.spring.k_y / 1.0001)
        softer = [*CHAIN.springs[:place], spring, *CHAIN.springs[place + 1 :]]
        gained = np.linalg.inv(stiffness(CHAIN.turn, softer)) - total
        assert gained[0, 0] / total[0, 0] == pytest.approx(1e-4 * part.along_x, rel=1e-6)
        assert gained[1, 1] / total[1, 1] == pytest.approx(1e-4 * part.along_y, rel=1e-6)
    line = chain_sections(found)[0].sentences[0]
    assert "along x is: leaf springs, with 92 % of the compliance; along y: drive, with" in line
    assert softest_path(CHAIN) == "springs.leaf-springs.k_x"
    side = CHAIN.replace(springs=[st.Spring("a", "rigid", 1e3, "80 deg"), *CHAIN.springs])
    assert softest_path(side) == "springs.a.k_y"
    soft = [CHAIN.springs[1], st.Spring("leaf springs", 1e3, 1e6)]
    line = chain_sections(replace(found, chain=examine(CHAIN.replace(springs=soft), 0)))[0]
    assert "The softest is: leaf springs, with 98 % of the compliance along x and 83 %" in str(line)


def test_a_compliance_is_told_as_such(found):
    leaf = st.Spring("leaf springs", compliance_x="833.3333 um/N", k_y="30 MN/m")
    soft = CHAIN.replace(springs=[*CHAIN.springs[:2], leaf])
    path = softest_path(soft)
    assert path == "springs.leaf-springs.compliance_x"
    assert name_of(replace(found, slider=soft), path) == "compliance_x of the leaf springs"
    values = list(further(soft, path))
    assert values == sorted(values, reverse=True)
    assert values[0] == 0.00042  # half of it, in two digits: less of it is stiffer
    table = chain_sections(replace(found, chain=examine(soft, 0)))[0].table
    assert table.rows[2][1:3] == ("1.2 kN/m", "30 MN/m")


@pytest.mark.parametrize("number", range(6))
def test_each_replacement_is_what_a_single_spring_of_its_tensor_does(found, number):
    each = found.chain.replacements[number]
    assert (each.spring, each.factor) == (CHAIN.springs[number // 2], (2.0, inf)[number % 2])
    place = number // 2
    stiff = each.spring._replace(
        k_x=each.spring.k_x * each.factor, k_y=each.spring.k_y * each.factor
    )
    other = single(CHAIN, [*CHAIN.springs[:place], stiff, *CHAIN.springs[place + 1 :]])
    V, F_0 = 20e-3, other.F_0
    A = F_0 / (2.0 * V * np.sin(abs(other.phi)) * np.sqrt(0.25 * other.k_x))
    assert pytest.approx(A, rel=1e-9) == each.prediction.A
    assert each.prediction.zeta == pytest.approx(A * np.sin(abs(other.phi)) ** 3, rel=1e-9)
    assert each.prediction.f_y == pytest.approx(np.sqrt(other.k_y / 0.25) / (2 * pi), rel=1e-9)
    settings = each.tried.run.description.run
    run = st.simulate(other, settings.duration, sample_rate=settings.sample_rate)
    record = st.analysis.record_of(run)
    row = chain_sections(found)[1].table.rows[number + 1]
    # another start of the same steps: rounding, grown by the motion to no more than rtol's share
    assert float(row[5]) == pytest.approx(record.force.max() / 10.0, rel=1e-3)
    slides = np.abs(run.data["V_X"].values[-len(run.data.time) // 8 :] / V - 1.0).max() < 0.02
    assert (row[6] == "steady sliding") == slides


def test_the_first_row_is_the_apparatus_as_it_is(found):
    sections = chain_sections(found)
    first = sections[1].table.rows[0]
    assert first[0] == "all as they are"
    assert first[6] == final_motion(found.observation)
    assert len(sections[1].table.rows) == 7
    assert sections == found.tables()[-2:]
    assert chain_sections(replace(found, chain=None)) == []
    assert found.ok


def test_what_would_make_all_rigid_is_said_to():
    slider = CHAIN.replace(springs=[CHAIN.springs[0], st.Spring("leaf", 1e3, 1e7)], phi="9 deg")
    found = st.audit(slider)
    rigid = found.chain.replacements[3]
    assert (rigid.slider, rigid.tried) == (None, None)
    assert "not possible" in chain_sections(found)[1].table.rows[4][-1]


@pytest.mark.parametrize("seed", range(20))
def test_what_a_mass_adds_by_the_dynamic_stiffness_of_both_nodes(seed):
    """(M77) in the plane: the inner node with its mass, eliminated at one frequency."""
    rng = np.random.default_rng(seed)
    tensors = [
        principal(*np.exp(rng.uniform(5.0, 9.0, 2)), float(rng.uniform(-1.5, 1.5))) for _ in "12"
    ]
    near, far = tensors
    e, mass = axis(float(rng.uniform(-3, 3))), 0.1
    beyond = np.linalg.inv(far)
    omega = float(np.sqrt(rng.uniform(0.01, 0.5) / (mass * np.linalg.eigvalsh(beyond).max())))
    K = np.block([[near, -near], [-near, near + far - mass * omega**2 * np.eye(2)]])
    dynamic = np.linalg.inv(K)[:2, :2]
    expected = e @ (dynamic - np.linalg.inv(near) - beyond) @ e
    assert yield_of_mass(mass, omega, beyond, e) == pytest.approx(expected, rel=1e-9)
    # above its resonance along e
    high = 1.01 / np.sqrt(mass * float(e @ beyond @ e))
    assert isinf(yield_of_mass(mass, high, beyond, e))


@pytest.mark.parametrize("mass", [1e-4, 3e-3, 2e-2])
def test_frequencies_are_lower_by_half_of_it(mass):
    """Against the eigenvalues of slider and part together, along aligned axes."""
    near, far = st.Spring("near", 4e3, 5e6), st.Spring("far", 2e3, 8e6, mass=mass)
    slider = PAPER.replace(springs=[near, far], phi="3 deg")
    frequencies = []
    for k_1, k_2 in ((4e3, 2e3), (5e6, 8e6)):
        K = np.array([[k_1, -k_1], [-k_1, k_1 + k_2]])
        square = eigh(K, np.diag([0.25, mass]), eigvals_only=True)[0]
        frequencies.append(np.sqrt(square / (k_1 * k_2 / (k_1 + k_2) / 0.25)))
    more = parts(slider)[1].more
    lower = 1.0 - min(frequencies)
    # to second order in the share
    assert lower == pytest.approx(0.5 * more, abs=more**2)
    # and by the bound of (M77)
    share = mass / 0.25 * (4e3 / 6e3)
    assert more <= share / (1.0 - share)
    (line,) = masses(st.audit(slider).chain) if mass == 3e-3 else ("",)
    assert not line or ("which is little" in line) == (more < SMALL)


def test_a_mass_next_to_the_slider_belongs_to_it():
    springs = [CHAIN.springs[0]._replace(mass=0.03), CHAIN.springs[1]]
    (near, _) = parts(CHAIN.replace(springs=springs))
    assert near.more == pytest.approx(0.03 / 0.25, rel=0.15)
