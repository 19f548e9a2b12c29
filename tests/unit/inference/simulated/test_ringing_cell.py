"""A load cell that rings: simulations show what is left of a force that was restored behind it."""

import numpy as np
import pytest
from scipy.signal import bilinear, lfilter, lfilter_zi

import stiction as st
from stiction.analysis.motion.load_cell.free_swings import RingingCell, without_free_swings
from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.robust import block_means
from stiction.inference.observation import Noise, noise_of_means, observe
from stiction.inference.simulated.synthetic import restore

RATE = 2e3  # Hz
FRICTION = st.ExponentialWeakening(mu_0=0.4, mu_inf=0.2, v_f="5 mm/s")
SLIDER = st.Slider(
    mass=0.25, k_x=1e3, k_y=1e6, phi="1 deg", normal_load=10.0, c_x=1.0,
    friction=FRICTION, drive=st.ConstantVelocity(velocity="0.7 mm/s"),
)  # fmt: skip


def cycles(random, count=30):
    """Return a force whose slips last 50 ms, and differ."""
    rise = np.append(np.linspace(0.0, 1.0, 3000), np.linspace(1.0, 0.0, 100))
    return 2.0 + np.concatenate([size * rise for size in random.uniform(0.9, 1.1, count)])


def behind(cell, force):
    """Return what a load cell shows."""
    turns = 2.0 * RATE * np.tan(np.pi * cell.frequency / RATE)
    its = bilinear([turns**2], [1.0, turns / cell.quality, turns**2], RATE)
    return lfilter(*its, force, zi=lfilter_zi(*its) * force[0])[0]


def drawn_cell(random):
    """Return a cell that swings a few times or often in a cycle of 1.55 s."""
    frequency = float(np.exp(random.uniform(*np.log([4.0, 40.0]))))
    quality, highest = random.uniform(3.0, 30.0), random.uniform(2.0, 6.0)
    return RingingCell(frequency, quality, highest * frequency)


@pytest.mark.parametrize("seed", range(6))
def test_a_simulated_force_is_as_smooth_as_one_that_was_restored(seed):
    random = np.random.default_rng(seed)
    force, cell = cycles(random), drawn_cell(random)
    grid = even_grid(np.arange(len(force)) / RATE)
    measured = without_free_swings(grid, behind(cell, force), cell)
    simulated = restore(force, np.zeros(len(force)), 1.0 / RATE, 1, cell)
    kept = slice(2000, -2000)  # the ends are odd about themselves
    assert np.std((simulated - force)[kept]) > 1e-3
    assert np.std((measured - simulated)[kept]) < 0.1 * np.std((simulated - force)[kept])


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("block", [1, 8])
def test_means_of_a_restored_force_have_the_noise_that_is_stated(block, seed):
    random = np.random.default_rng(seed)
    cell, step, size = drawn_cell(random), 1.0 / RATE, 64_000
    readings = 0.01 * random.standard_normal(size)
    measured = block_means(
        without_free_swings(even_grid(step * np.arange(size)), readings, cell), block
    )
    stated = noise_of_means(Noise(0.01, cell=cell), block, step).level
    assert 0.97 * np.std(measured) < stated < 1.28 * np.std(measured)  # rounded up by a quarter
    white = stated * block**0.5 * random.standard_normal(size)
    simulated = block_means(restore(np.zeros(size), white, step, block, cell), block)
    assert np.std(simulated) == pytest.approx(stated, rel=0.03)
    power = [np.abs(np.fft.rfft(each / each.std())) ** 2 for each in (measured, simulated)]
    quarters = [[part.mean() for part in np.array_split(each, 4)] for each in power]
    assert np.allclose(np.log(quarters[0]), np.log(quarters[1]), atol=0.2)


@pytest.mark.parametrize("stated", [None, st.Sensor(noise="4 mN")])
def test_a_record_is_observed_with_its_load_cell(stated):
    random = np.random.default_rng(2)
    force, cell = cycles(random), RingingCell(8.0, 10.0, 20.0)
    force = behind(cell, force) + 4e-3 * random.standard_normal(len(force))
    sensors = None if stated is None else {"force": stated}
    record = st.Record(time=np.arange(len(force)) / RATE, force=force, sensors=sensors)
    noise = observe(record, SLIDER).conditions.noise["force"]
    assert noise.cell.frequency == pytest.approx(cell.frequency, rel=0.02)
    assert noise.cell.quality == pytest.approx(cell.quality, rel=0.2)
