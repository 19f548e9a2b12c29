"""Springs in series, (M75) to (M76), against the stiffness matrix with inner nodes eliminated."""

from math import inf

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.system.parameter import change_parameter, change_unchecked, read, unit, units
from stiction.system.springs import compliance, scale_stiffness, whole
from stiction.system.tensors import damping_tensor, mass_tensor, principal

PAPER = st.presets.nakano_popov_2020()
CELL = st.Spring("load cell", k_x="20 kN/m", k_y="rigid", angle="2 deg", mass="20 g")
DRIVE = st.Spring("Drive", k_x="50 kN/m", k_y="5 MN/m", angle="-11 deg")
LEAF = st.Spring("leaf springs", k_x="1 kN/m", k_y="10 MN/m")
CHAIN = PAPER.replace(springs=[CELL, DRIVE, LEAF])
# logarithms of the stiffnesses, angles (deg) of four springs, and how many are used
RANGES = (*((0, 20),) * 4, *((0, 20),) * 4, *((-180, 180),) * 4, (1, 4.999))


def chain(row):
    """Return springs of a random row; one of four directions is rigid, not two of one spring."""
    soft, hard, angles, count = row[:4], row[4:8], row[8:12], int(row[12])
    rows = zip(range(count), soft, hard, angles, strict=False)
    return tuple(
        st.Spring(
            f"part {i}",
            float(np.exp(a)),
            inf if b > 15.0 and i else float(np.exp(b)),
            f"{angle!r} deg",
        )
        for i, a, b, angle in ((i, a, b, float(angle)) for i, a, b, angle in rows)
    )


def eliminate(springs):
    """Return the compliance at the slider's node, of all nodes but the drive's, held.

    Displacements of the nodes minimise the energy; rigid directions are constraints (multipliers).
    """
    n = len(springs)
    K, rigid = np.zeros((2 * n, 2 * n)), []
    for i, spring in enumerate(springs):
        B = np.zeros((2, 2 * n))
        B[:, 2 * i : 2 * i + 2] = np.eye(2)
        if i + 1 < n:
            B[:, 2 * i + 2 : 2 * i + 4] = -np.eye(2)
        for k, angle in ((spring.k_x, spring.angle), (spring.k_y, spring.angle + np.pi / 2)):
            row = np.array([np.cos(angle), np.sin(angle)]) @ B
            if np.isinf(k):
                rigid.append(row)
            else:
                K += k * np.outer(row, row)
    G = np.array(rigid).reshape(-1, 2 * n)
    system = np.block([[K, G.T], [G, np.zeros((len(G), len(G)))]])
    loads = np.eye(len(system))[:, :2]
    # rows and columns differ by many decades
    scale = 1.0 / np.sqrt(np.abs(system).max(axis=1))
    solved = scale[:, None] * np.linalg.solve(
        scale[:, None] * system * scale, scale[:, None] * loads
    )
    return solved[:2], np.linalg.cond(scale[:, None] * system * scale)


@pytest.mark.parametrize("row", inside(300, *RANGES))
def test_compliances_add_as_if_inner_nodes_were_eliminated(row):
    springs = chain(row)
    k_x, k_y, angle = whole(springs)
    made = principal(1.0 / k_x, 1.0 / k_y, angle)
    expected, condition = eliminate(springs)
    size = np.abs(expected).max()
    assert np.abs(made - expected).max() <= 1e-15 * (10.0 + condition) * size
    # the softer compliances differ by decades: the stiffer one is right to its own digits
    tensors = [compliance(each) for each in springs]
    assert np.abs(sum(tensors) - made).max() <= 1e-14 * size
    assert abs(angle) <= np.pi / 4


def test_the_stiffer_direction_keeps_its_digits():
    """Twelve decades softer along x, and parts hardly askew: exact in integers of 50 digits."""
    from fractions import Fraction as F

    springs = tuple(
        st.Spring(f"part {i}", k_x=1.0 + i, k_y=1e12 / (1.0 + i), angle=f"{i * 1e-7!r} rad")
        for i in range(3)
    )
    S = [[F(0), F(0)], [F(0), F(0)]]
    for each in springs:
        a = F(each.angle)
        c, s = 1 - a**2 / 2 + a**4 / 24, a - a**3 / 6 + a**5 / 120  # to 1e-50
        for k, (x, y) in ((each.k_x, (c, s)), (each.k_y, (-s, c))):
            for i, j in np.ndindex(2, 2):
                S[i][j] += (x, y)[i] * (x, y)[j] / F(k)
    determinant = float(S[0][0] * S[1][1] - S[0][1] * S[1][0])
    k_x, k_y, _ = whole(springs)
    assert 1.0 / (k_x * k_y) == pytest.approx(determinant, rel=1e-9)


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_equal_springs_in_series_are_one(count):
    each = (count * PAPER.k_x, count * PAPER.k_y)
    slider = PAPER.replace(springs=[st.Spring(f"part {i}", *each) for i in range(count)])
    assert (slider.k_x, slider.k_y) == pytest.approx((PAPER.k_x, PAPER.k_y), rel=1e-15)
    assert (slider.turn, slider.misalignment) == (0.0, PAPER.phi)


def test_the_order_does_not_matter():
    back = CHAIN.replace(springs=CHAIN.springs[::-1])
    assert (back.k_x, back.k_y) == pytest.approx((CHAIN.k_x, CHAIN.k_y), rel=1e-15)
    assert back.turn == pytest.approx(CHAIN.turn, rel=1e-13)


@pytest.mark.parametrize("angle", [10.0, -35.0])
def test_angles_may_count_from_any_line(angle):
    """Turned together, all axes and the drive make the same apparatus."""
    base = CHAIN.replace(
        drive=st.ConstantVelocity("40 mm/s"),
        mass_y="0.4 kg",
        mass_angle="20 deg",
        c_x=1.0,
        c_y=3.0,
        damping_angle="-15 deg",
    )

    def deg(value):
        return f"{float(np.degrees(value)) + angle!r} deg"

    turned = base.replace(
        phi=deg(base.phi),
        mass_angle=deg(base.mass_angle),
        damping_angle=deg(base.damping_angle),
        springs=[
            each._replace(angle=each.angle + float(np.radians(angle))) for each in base.springs
        ],
    )
    assert (turned.k_x, turned.k_y) == pytest.approx((base.k_x, base.k_y), rel=1e-13)
    assert turned.misalignment == pytest.approx(base.misalignment, abs=1e-14)
    for tensor in (mass_tensor, damping_tensor):
        np.testing.assert_allclose(tensor(turned), tensor(base), rtol=1e-12)
    a, b = (st.simulate(each, "50 ms", sample_rate="1 kHz", rtol=1e-8) for each in (base, turned))
    for name in ("X", "Y", "u_x", "mu", "theta"):
        off = np.nanmax(np.abs(a.data[name].values - b.data[name].values))
        assert off < 1e-6 * np.nanmax(np.abs(a.data[name].values))


def test_a_chain_runs_as_the_spring_that_it_makes():
    """To the last bit: the solver sees one spring."""
    single = PAPER.replace(k_x=CHAIN.k_x, k_y=CHAIN.k_y, phi=f"{CHAIN.misalignment!r} rad")
    a, b = (st.simulate(each, "30 ms", sample_rate="1 kHz").data for each in (CHAIN, single))
    for name in a.data_vars:
        np.testing.assert_array_equal(a[name].values, b[name].values)
    growths = [st.linear_stability.growth_rate(each) for each in (CHAIN, single)]
    assert growths[0] == growths[1]


def test_a_grain_lies_at_its_angle_to_the_drive():
    law = st.laws.Anisotropic(st.Coulomb(0.2), 1.5, "30 deg")
    single = PAPER.replace(k_x=CHAIN.k_x, k_y=CHAIN.k_y, phi=f"{CHAIN.misalignment!r} rad")
    a, b = (
        st.simulate(each.replace(friction=law), "30 ms", sample_rate="1 kHz").data["theta"].values
        for each in (CHAIN, single)
    )
    np.testing.assert_array_equal(a, b)


def test_it_is_written_and_read_back(tmp_path):
    whole_ = st.Description(CHAIN, st.Initial(), st.Settings(duration="5 ms", sample_rate="1 kHz"))
    assert st.Slider.from_toml(CHAIN.to_toml()) == CHAIN
    assert st.Description.from_json(whole_.to_json()) == whole_
    assert eval(repr(CHAIN), {"st": st}) == CHAIN
    assert "k_x='rigid'" in repr(st.Spring("a", "rigid", 1e3))
    run = st.run(whole_)
    assert st.load(run.save(tmp_path / "chain.nc")).slider == CHAIN
    tables = CHAIN.to_toml().replace("springs = [", "# [").split("\n")
    rows = [line.strip(" ,{}") for line in tables if line.startswith("    {")]
    text = "\n".join(line for line in tables if not line.startswith(("    {", "# [", "]")))
    parts = "".join(f"[[slider.springs]]\n{row.replace(', ', chr(10))}\n" for row in rows)
    assert st.Slider.from_toml(text.replace("[friction]", f"{parts}[friction]")) == CHAIN
    assert "load cell" in CHAIN._repr_html_()
    assert "springs" not in st.Description(PAPER, *whole_[1:]).to_json()


SOFT = CELL._replace(k_x=None, compliance_x=5e-5)


def test_a_compliance_stands_in_place_of_a_stiffness():
    for cell in (SOFT, SOFT._replace(k_y=None, compliance_y=0.0)):
        slider = CHAIN.replace(springs=[cell, DRIVE, LEAF])
        assert (slider.k_x, slider.k_y) == pytest.approx((CHAIN.k_x, CHAIN.k_y), rel=1e-15)
        assert st.Slider.from_toml(slider.to_toml()) == slider
        assert eval(repr(slider), {"st": st}) == slider
        description = st.Description(slider, st.Initial(), st.Settings(duration="5 ms"))
        assert st.Description.from_json(description.to_json()) == description
    assert 'compliance_x = "50 um/N"' in slider.to_toml()
    assert "springs.load-cell.k_x" not in units(slider)
    path = "springs.load-cell.compliance_x"
    assert unit(slider, path) == "m/N"
    softer = change_parameter(slider, path, "100 um/N")
    assert softer == change_unchecked(slider, path, 1e-4)
    assert softer.k_x < slider.k_x
    changed = st.Slider.from_toml(slider.to_toml(), {path: "100 um/N"})
    assert changed == softer


@pytest.mark.parametrize("factor", [2.0, inf])
def test_a_stiffened_spring_yields_less_by_that_factor(factor):
    for spring in (CELL, SOFT, DRIVE):
        np.testing.assert_array_equal(
            scale_stiffness(spring, factor).compliances, np.array(spring.compliances) / factor
        )


def test_each_number_has_a_path_by_name_or_place():
    assert unit(CHAIN, "springs.load-cell.k_x") == unit(CHAIN, "springs.1.k_x") == "N/m"
    assert read(CHAIN, "springs.drive.k_y") == read(CHAIN, "slider.springs.2.k_y") == 5e6
    assert "springs.load-cell.angle" in units(CHAIN)
    assert "k_x" not in units(CHAIN)
    for path in ("springs.leaf-springs.k_x", "springs.3.k_x"):
        new = change_parameter(CHAIN, path, "2 kN/m")
        assert new == change_unchecked(CHAIN, path, 2e3)
        assert new.k_x > CHAIN.k_x
    written = st.Slider.from_toml(
        CHAIN.to_toml(), {"springs.leaf-springs.k_x": "2 kN/m", "slider.springs.2.k_y": "6 MN/m"}
    )
    assert [each.k_x for each in written.springs] == [2e4, 5e4, 2e3]
    assert written.springs[1].k_y == 6e6
    base = st.Description(CHAIN, st.Initial(), st.Settings(duration="5 ms"))
    study = st.Study(
        base=base, axes={"springs.drive.k_x": st.Grid("1 kN/m", "9 kN/m", 3)}, measures=["regime"]
    )
    assert study.description((1,)).slider.springs[1].k_x == 5e3


def test_the_drive_stays_where_it_is_when_a_spring_changes():
    """Only the principal axes turn: phi is the drive's, misalignment the whole's."""
    new = change_parameter(CHAIN, "springs.drive.k_x", "2 kN/m")
    assert new.phi == CHAIN.phi
    assert new.turn < CHAIN.turn
    assert new.misalignment + new.turn == pytest.approx(CHAIN.phi, rel=1e-14)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"k_x": 3.0}, r"k_x: follows from springs; leave it out"),
        ({"springs": 3}, r"springs: 3 is not a list of springs"),
        ({"springs": [CELL]}, r"are rigid together along some axis"),
        ({"springs": [CELL, CELL, LEAF]}, r"'load cell' stands twice"),
        ({"springs": [{"name": "a", "k_x": 1.0}]}, r"springs\.1\.k_y: missing; give k_y, or co"),
        (
            {"springs": [SOFT._asdict() | {"angle": "2 deg", "k_x": 1.0}]},
            r"1\.compliance_x: says the",
        ),
        (
            {"springs": [{"name": "a", "compliance_x": -1.0, "k_y": 1.0}]},
            r"compliance_x: must not be",
        ),
        (
            {"springs": [{"name": "a", "compliance_x": "2 kN/m", "k_y": 1.0}]},
            r"is in kN/m, not a unit",
        ),
        ({"springs": [{"name": "1", "k_x": 1.0, "k_y": 1.0}]}, r"springs\.1\.name: must have a"),
        ({"springs": [{"name": "a", "k_x": -1, "k_y": "5 kg"}]}, r"k_x: must be greater than 0"),
        ({"springs": ["cell"]}, r"'cell' is not a spring; write st\.Spring"),
        ({"springs": ()}, r"k_x: missing"),
        ({"phi": "95 deg"}, r"phi: must lie between -90 deg and 90 deg"),
        ({"springs": [LEAF._replace(k_x=-1)], "mass": -1}, r"mass: must be greater"),
    ],
)
def test_faults(changes, says):
    with pytest.raises(st.DescriptionError, match=says):
        CHAIN.replace(**changes)


def test_faults_of_paths():
    with pytest.raises(st.DescriptionError, match=r"k_x: follows from springs in series; change"):
        change_parameter(CHAIN, "k_x", 1.0)
    with pytest.raises(st.DescriptionError, match=r"did you mean 'springs\.load-cell\.k_x'"):
        change_parameter(CHAIN, "springs.cell.k_x", 1.0)
    with pytest.raises(st.DescriptionError, match=r"known as load-cell, drive, leaf-springs"):
        st.Slider.from_toml(CHAIN.to_toml(), {"springs.cell.k_x": 1.0})


@pytest.mark.parametrize("angle", ["3 deg", "-3 deg"])
def test_every_misalignment_is_looked_at_whichever_way_the_springs_turn(angle):
    turned = [CELL._replace(angle=float(np.radians(float(angle.split()[0])))), LEAF]
    slider = PAPER.replace(springs=turned, phi="0 deg")
    assert slider.turn * slider.misalignment < 0.0
    found = st.linear_stability.critical(slider, "phi")
    single = PAPER.replace(k_x=slider.k_x, k_y=slider.k_y)
    expected = st.linear_stability.critical(single, "phi").values
    np.testing.assert_allclose(np.sort(abs(found.values - slider.turn)), expected, rtol=1e-9)
    way = np.sign(slider.misalignment)
    ends = sorted((slider.turn, way * np.pi / 2))
    np.testing.assert_allclose(found.between, ends, rtol=1e-15)
