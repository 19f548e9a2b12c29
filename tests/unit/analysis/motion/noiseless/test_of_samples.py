"""The kind of a run's motion, however many samples it has, and in a study."""

import numpy as np
import pytest
from benchmarks.explore.rigs.sampling import DENSER, look

import stiction as st
from stiction.analysis.motion.noiseless.zigzag import find_turns, zigzag
from stiction.analysis.motion.regime.kinds import STUCK, UNDETERMINED
from stiction.study.variables.observed_run import observe_run

PAPER = st.presets.nakano_popov_2020()


@pytest.mark.parametrize("number", [0, 1, 2, 3, *range(5, 12)])
def test_kind_and_cycles_are_those_of_more_samples_and_of_a_study(number):
    seen = look(11, number)
    assert len(seen.judged) == len(DENSER) + 1
    assert not seen.differ or seen.marginal, seen


STUCK_BY_SAMPLES = PAPER.replace(
    k_y=1339083.1, phi="12 deg", friction=st.Coulomb(mu_0=0.2, mu_static=0.25),
    drive=st.ConstantVelocity("0.138 mm/s"),
)  # fmt: skip
FAST_CREEP = PAPER.replace(
    k_y=2.5e5, phi="85 deg", friction=st.Coulomb(mu_0=0.2), c_x=1.0,
    drive=st.ConstantVelocity("0.45 mm/s"),
)  # fmt: skip


@pytest.mark.parametrize(("slider", "duration"), [(STUCK_BY_SAMPLES, 8.14), (FAST_CREEP, 8.0)])
def test_a_run_is_not_stuck_or_sliding_by_its_samples(slider, duration):
    """One was "stuck (0.89)" at 60 000 samples, and stick-slip (1.00) at 100 000."""
    kinds = {
        st.analysis.classify(st.simulate(slider, duration, sample_rate=count / duration)).kind
        for count in (16e3, 60e3, 100e3)
    }
    assert kinds == {observe_run(st.Description.of(slider, duration), None).regime}
    assert STUCK not in kinds


@pytest.mark.parametrize("rate", [1.0, 3.0, 7.0])
def test_samples_farther_apart_than_the_cycles_show_nothing(rate):
    """The force then seems to swing slowly, as if it were regular."""
    slider = PAPER.replace(phi="8.2 deg", drive=st.ConstantVelocity("10 mm/s"))
    found = st.analysis.classify(st.simulate(slider, 60.0, sample_rate=rate))
    assert found.kind == UNDETERMINED
    assert found.confidence == 0.0
    assert found.evidence["rate_needed"] > 2.0 * slider.natural_frequencies[0]
    assert "too far apart to show the motion" in str(found)


@pytest.mark.parametrize("count", [1, 2, 3, 40])
def test_few_samples_of_a_run_are_no_error(count):
    run = st.simulate(PAPER, 1.0, times=np.linspace(0.0, 1.0, count) if count > 1 else [0.5])
    assert st.analysis.classify(run).kind in (UNDETERMINED, STUCK)
    assert st.analysis.find_cycles(run).sizes["cycle"] == 0


def test_turning_points_lie_between_samples():
    """Eight samples a period miss the peaks of a sine by up to 8 %; cubics by 1e-3."""
    t = np.arange(0.0, 4.0, 0.125) + 0.03
    turn = 2.0 * np.pi
    when, value = np.empty(2 * len(t)), np.empty(2 * len(t))
    count = find_turns(t, np.sin(turn * t), turn * np.cos(turn * t), 1.9, when, value)
    assert count == 7
    np.testing.assert_allclose(when[:count], 0.25 + 0.5 * np.arange(count), atol=0.01)
    np.testing.assert_allclose(np.abs(value[:count]), 1.0, atol=0.02)
    assert list(zigzag(np.array([0.0, 2.0, 1.9, 3.0, 1.0, 2.0]), 0.5)) == [3, 4]


@pytest.mark.parametrize(
    ("phi", "k_y", "V", "cell"),
    [(4.8, 4e5, 3e-4, 0.0), (4.0, 8e5, 6e-4, 0.0), (9.9, 3e5, 4e-3, 0.0), (2.7, 6e5, 1e-3, -5.0)],
)
def test_the_oscillation_that_a_turned_cell_reads_is_no_cycle(phi, k_y, V, cell):
    """A cell along the drive reads k_y u_y sin(phi), too: 1588 cycles in place of 11."""
    rig = st.presets.nakano_popov_2020().replace(
        phi=f"{phi} deg", k_y=k_y, drive=st.ConstantVelocity(V)
    )
    duration = 4.0 * rig.loading_time
    turned, plain = (
        st.analyse(st.simulate(each, duration))
        for each in (rig.replace(cell_angle=f"{cell} deg"), rig)
    )
    assert turned.regime.kind == plain.regime.kind == "stick-slip"
    counts = [len(each.cycles["cycle"]) for each in (turned, plain)]
    assert min(counts) > 2
    assert abs(counts[0] - counts[1]) <= 1  # the last may be cut
