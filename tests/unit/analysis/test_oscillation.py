"""The oscillation's frequency and share of the cycle; spectra of records larger than memory."""

import tracemalloc
from math import pi, sin

import numpy as np
import pytest
import xarray as xr
from scipy.signal import ShortTimeFFT, lfilter
from scipy.signal.windows import hamming
from tests.measured import read_measured

import stiction as st
from stiction.analysis.measured_line import strongest_line
from stiction.analysis.oscillation import apart, stands_out
from stiction.analysis.signals.ridge import best_path
from stiction.analysis.signals.spectrum import even_rate
from stiction.plotting.analysis.oscillation import plot_oscillation
from stiction.plotting.page.canvas import figure_of

RATE = 2000.0
NOISE = np.random.default_rng(5).normal(size=40_000)


@pytest.fixture(scope="module")
def oscillation(paper_run):
    return st.analysis.transverse_oscillation(paper_run)


def oscillates(oscillation, least: float):
    """Where it sticks every period; not where slip ends in a stick or where that begins."""
    stuck = (oscillation["share_stuck"] > least) & (oscillation["share_stuck"] < 0.08)
    return stuck & (oscillation["sticks_per_second"] > 300)


def phases(run: st.Trajectory) -> np.ndarray:
    cycles = st.analysis.find_cycles(st.analysis.record_of(run))
    return np.column_stack([cycles["start"].values, cycles["peak_time"].values])


def test_the_oscillation_falls_as_the_sine_of_the_force_angle(oscillation):
    assert float(oscillation["frequency"][0]) == pytest.approx(
        oscillation.attrs["natural_frequency"], rel=0.01
    )  # each stick lengthens the period by some 0.5 %
    singing = oscillation.isel(time=oscillates(oscillation, 0.03))
    ratio = (singing["frequency"] / singing["expected"]).values
    assert len(ratio) > 300
    assert ratio == pytest.approx(0.995, abs=0.006)
    assert float(singing["frequency"].min()) < 0.5 * oscillation.attrs["natural_frequency"]


@pytest.mark.parametrize(
    "changes",
    [
        {"phi": "3 deg"},
        {"c_y": 20.0},
        {"driven": "spring"},
        {"load": st.protocols.LoadProgram(modulation=st.protocols.Modulation(1.0, 0.7))},
    ],
)
def test_so_does_that_of_other_systems(slider, changes):
    run = st.simulate(slider.replace(**changes), 1.5, sample_rate=10e3)
    oscillation = st.analysis.transverse_oscillation(run)
    ratio = (oscillation["frequency"] / oscillation["expected"]).values[
        oscillates(oscillation, 0.03).values
    ]
    assert len(ratio) > 80
    # a load that sways moves the force by as much within a window
    assert ratio == pytest.approx(0.995, abs=0.015)


def test_what_has_died_away_is_not_heard(slider):
    """With constant friction there is one stick, then steady sliding with the solver's noise."""
    run = st.simulate(slider.replace(friction=st.Coulomb(0.2)), 3.0, sample_rate=10e3)
    oscillation = st.analysis.transverse_oscillation(run)
    assert oscillation["frequency"].sel(time=slice(0.1, 1.0)).notnull().all()
    assert not oscillation["frequency"].sel(time=slice(2.2, None)).notnull().any()


def test_it_swings_up_to_its_bound_and_sticks_once_a_period(oscillation):
    singing = oscillation.isel(time=oscillates(oscillation, 0.06))
    share = (singing["velocity"] / singing["velocity_bound"]).values
    # in between it swings a little further back, where friction has helped
    assert 1.0 < share.min() < share.max() < 1.06
    off = (singing["sticks_per_second"] - singing["frequency"]).values
    assert np.abs(off).max() < 1.5 / oscillation.attrs["width"]  # counts are whole
    known = oscillation["amplitude"] * 2 * pi * oscillation["frequency"]
    np.testing.assert_allclose(known, oscillation["velocity"].where(known.notnull()), rtol=1e-12)
    bound = 1e-3 * sin(np.radians(1)) / (2 * pi * oscillation.attrs["natural_frequency"])
    assert float(oscillation["amplitude_bound"][0]) == pytest.approx(bound, rel=1e-12)


def test_ring_down_and_micro_stick_slip_share_each_phase(paper_run, oscillation):
    table = st.analysis.oscillation_by_phase(oscillation, paper_run, phases(paper_run))
    begin, end = paper_run.stick_intervals.T
    for phase in range(3):
        row = table.isel(phase=phase)
        inside = (begin >= float(row["start"])) & (end <= float(row["end"]))
        assert abs(int(row["sticks"]) - inside.sum()) <= 1  # one may reach over the start
        assert float(row["rings_from"]) == end[inside][-1]
        length = float(row["end"] - row["start"])
        stuck = (end - begin)[inside].sum()
        assert float(row["share_stuck"]) == pytest.approx(stuck / length, abs=0.01)
        assert 0.15 < float(row["ring_down"]) < 0.25
        assert 700 < float(row["first_frequency"]) < 850
        assert float(row["last_frequency"]) < 300


def test_sampled_too_coarsely_it_is_not_heard(slider):
    run = st.simulate(slider, 0.1, sample_rate=2e3)
    with pytest.raises(st.ResultError, match=r"is at 1.007 kHz; sample the run at 5.1 kHz"):
        st.analysis.transverse_oscillation(run)


def test_a_ridge_is_finer_than_its_lines_and_keeps_to_its_own():
    time = np.arange(40_000) / RATE
    rising = np.sin(2 * pi * (200.0 * time + 2.5 * time**2))  # 200 to 300 Hz in 20 s
    burst = np.where(abs(time - 7.0) < 0.2, 3.0 * np.sin(2 * pi * 600.0 * time), 0.0)
    lines = st.analysis.spectrogram(rising + burst + 0.5 * NOISE, RATE, width=0.25, step=0.05)
    found = st.analysis.follow_ridge(lines, 50.0, 900.0)
    off = found["frequency"].values - (200.0 + 5.0 * found["time"].values)
    assert np.abs(off).max() < 2.0  # lines are 4 Hz apart
    assert off.std() < 0.3
    assert float(found["amplitude"].median()) == pytest.approx(1.0, abs=0.06)


def test_a_mass_at_rest_has_no_line():
    """Rounding errors and zeros stand beside each other in its spectrum."""
    lines = np.full((60, 40), 1e-38)
    lines[::7] = 0.0
    lines[:, :3] = 1e-4 * (1.0 + 0.1 * np.random.default_rng(1).random((60, 3)))  # a slip
    axes = {"frequency": 10.0 * np.arange(60), "time": np.arange(40.0)}
    found = st.analysis.follow_ridge(xr.DataArray(lines, axes), 50.0, 550.0)
    assert not np.isfinite(found["frequency"].values).any()
    assert float(found["amplitude"].max()) < 2e-4


def test_the_best_path_is_the_best_of_all():
    """By trying every path of a small table."""
    draw = np.random.default_rng(2)
    for _ in range(20):
        level = draw.normal(size=(5, 5))
        found = best_path(level, 1, 0.3)
        paths = np.stack(np.meshgrid(*[range(5)] * 5), -1).reshape(-1, 5)
        steps = np.diff(paths, axis=1)
        gain = level[paths, np.arange(5)].sum(axis=1) - 0.3 * (steps**2).sum(axis=1)
        gain[np.abs(steps).max(axis=1) > 1] = -np.inf
        assert found.tolist() == paths[gain.argmax()].tolist()


def test_noise_has_no_line():
    record = st.Record(time=np.arange(len(NOISE)) / RATE, force=NOISE)
    found = st.analysis.strongest_line(record, 50.0)
    assert not np.isfinite(found["frequency"]).any()
    hum = NOISE + 0.5 * np.sin(2 * pi * 312.34 * record.time)
    found = st.analysis.strongest_line(st.Record(time=record.time, force=hum), 50.0)
    assert found["frequency"].values == pytest.approx(312.34, abs=0.1)  # lines are 0.5 Hz apart
    assert found["frequency"].attrs["units"] == "Hz"


@pytest.mark.parametrize("number", range(20))
def test_a_line_beside_a_harmonic_of_the_cycles_keeps_its_frequency(number: int):
    """The harmonic's samples of the spectrum are those of the line's lobe, too."""
    draw = np.random.default_rng([7, number])
    ends = np.cumsum(draw.uniform(0.95, 1.05, 20))
    time = np.arange(0.0, ends[-1], 1e-3)
    corners = np.stack([ends - draw.uniform(0.02, 0.1), ends]).T.ravel()
    force = 2.0 + np.interp(time, corners, np.tile([1.0, 0.0], len(ends)))
    hum = draw.uniform(11.0, 350.0)
    force += 10.0 ** draw.uniform(-1.5, -0.5) * np.sin(2.0 * pi * hum * time)
    record = st.Record(time=time, force=force + 1e-3 * draw.normal(size=len(time)))
    cycles = st.analysis.find_cycles(record)
    heard = st.analysis.strongest_line(record, low=10.0, cycles=cycles)
    errors = ((heard["frequency"] - hum) / heard["frequency_error"]).values
    assert np.isfinite(errors).sum() > 20
    assert np.nanmax(np.abs(errors)) < 3.0


def test_what_has_no_spectrum_is_refused():
    uneven = np.cumsum(np.where(np.arange(100) % 20, 1.0, 9.0))
    with pytest.raises(st.ResultError, match="of the time lies in gaps"):
        st.analysis.strongest_line(st.Record(time=uneven, force=NOISE[:100]), 0.1)
    record = st.Record(time=np.arange(100.0), force=NOISE[:100])
    with pytest.raises(st.ResultError, match="needs more than 6 samples a second, and"):
        st.analysis.strongest_line(record, 3.0)


@pytest.mark.parametrize(
    ("name", "low", "hum"),
    [("k168_v42", 40.0, 50.0), ("k2254_v42", 40.0, 50.0), ("k1002_v4300", 100.0, None)],
)  # the last one oscillates at 29 Hz itself
def test_a_measured_record_has_the_hum_of_the_mains_or_nothing(name, low, hum):
    heard = st.analysis.strongest_line(read_measured(name), low)["frequency"].values
    if hum is None:
        assert not np.isfinite(heard).any()
    else:
        assert heard == pytest.approx(hum, abs=0.2)


def test_the_spectrogram_is_scipy_s():
    transform = ShortTimeFFT(
        hamming(200, sym=False), 20, RATE, fft_mode="onesided", scale_to="magnitude"
    )
    first, last = transform.lower_border_end[1], transform.upper_border_begin(5000)[1]
    lines = 2.0 * np.abs(transform.stft_detrend(NOISE[:5000], "linear", p0=first, p1=last))
    lines[0] /= 2.0
    found = st.analysis.spectrogram(NOISE[:5000], RATE)
    assert found["frequency"].values == pytest.approx(transform.f, rel=1e-14)
    times = transform.t(5000, first, last)
    assert found["time"].values[: len(times)] == pytest.approx(times, rel=1e-14)
    assert found.values[:, : len(times)] == pytest.approx(lines, abs=1e-14)


@pytest.mark.parametrize("length", [1, 150, 200, 999, 40_000])
def test_pieces_are_the_whole(length):
    signal = NOISE[: 2000 if length == 1 else None]
    whole = st.analysis.spectrogram(signal, RATE, step=0.013, start=3.0)
    blocks = (signal[i : i + length] for i in range(0, len(signal), length))
    pieces = list(st.analysis.stream_spectrogram(blocks, RATE, step=0.013, start=3.0))
    assert np.concatenate([piece["time"] for piece in pieces]) == pytest.approx(
        whole["time"].values, rel=1e-15
    )
    found = np.concatenate([piece.values for piece in pieces], axis=1)
    assert np.abs(found - whole.values).max() < 1e-14


def test_a_record_larger_than_memory_is_streamed(tmp_path):
    peaks = []
    for length in (400_000, 4_000_000):
        path = tmp_path / f"{length}.bin"
        made = np.memmap(path, np.float64, "w+", shape=(length,))
        for i in range(0, length, 40_000):
            made[i : i + 40_000] = NOISE
        made.flush()
        tracemalloc.start()
        mean, count = 0.0, 0
        for piece in st.analysis.stream_spectrogram(
            np.memmap(path, np.float64, "r"), RATE, width=0.5, step=0.25
        ):
            mean, count = mean + piece.values.sum(axis=1), count + piece.sizes["time"]
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert count == (length - 1000) // 500 + 1
    assert peaks[1] < 1.05 * peaks[0]
    assert peaks[1] < 0.5 * 8 * 4_000_000  # of the record, 32 MB


def test_too_short_a_stream_is_refused():
    with pytest.raises(ValueError, match="holds 200 samples at 2000 Hz; there are 30 and"):
        list(st.analysis.stream_spectrogram([NOISE[:10], NOISE[:20]], RATE))


def test_harmonics_of_cycles_that_follow_closely_are_no_oscillation(oscillation):
    starts = 0.5 + 0.05 * np.arange(20)  # a window is 50 ms wide
    close = xr.Dataset({"period": ("cycle", np.full(20, 0.05)), "start": ("cycle", starts)})
    found = apart(oscillation, close)
    seen = np.isfinite(found["frequency"].values)
    assert seen.any()
    assert found["time"].values[seen].max() < 0.5
    far = close.assign(period=("cycle", np.full(20, 0.9)))
    assert apart(oscillation, far) is oscillation


def test_the_figure_says_what_is_drawn(paper_run, oscillation):
    axes = figure_of(plot_oscillation, paper_run, oscillation).axes
    assert [ax.get_ylabel() for ax in axes[:3]] == ["frequency (kHz)", "amplitude (1)", "stuck (%)"]
    assert axes[2].get_xlabel() == "time $t$ (s)"


@pytest.mark.parametrize("seed", range(5))
def test_a_bend_of_the_force_is_no_oscillation(seed):
    """A single break-away has every frequency in the windows around it, and none elsewhere."""
    time = np.arange(0.0, 10.0, 1e-3)
    fall = 2.4 + 0.6 * np.exp(-(time - 3.0) / 0.05)
    force = np.where(time < 3.0, time, fall)
    force = force + 0.004 * np.random.default_rng(seed).normal(size=len(time))
    assert "Seen in" not in str(st.analyse(st.Record(time=time, force=force)))
    line = force + 0.004 * np.sin(2 * np.pi * 40.0 * time)  # as high as the noise: it goes on
    assert "at 40 Hz" in str(st.analyse(st.Record(time=time, force=line)))


@pytest.mark.parametrize("color", [0, 1, 2])
def test_noise_of_any_color_has_no_line(color: int) -> None:
    """Random walks had one at the lower end of the band, above all others."""
    time = np.arange(20_000) * 1e-3
    for seed in range(5):
        force = np.random.default_rng(seed).normal(size=len(time))
        for _ in range(color):
            force = np.cumsum(force)
        found = strongest_line(st.Record(time=time, force=force), 5.0)
        assert np.isfinite(found["frequency"]).mean() < 0.05


@pytest.mark.parametrize("count", [300, 400, 650, 1000])
@pytest.mark.parametrize("like_the_one_before", [0.0, 0.5, 0.9])
def test_short_noise_has_no_line(count: int, like_the_one_before: float) -> None:
    """Of 400 samples in 85 of 100: a narrow band was compared with its last line, many times."""
    time, seen = np.arange(count) * 1e-3, 0
    for seed in range(100):
        white = np.random.default_rng((seed, count)).normal(size=count + 100)
        noise = lfilter([1.0], [1.0, -like_the_one_before], white)[100:]
        record = st.Record(time=time, force=1.0 + 0.01 * noise)
        seen += stands_out(strongest_line(record, 100.0 / record.duration))
    assert not seen  # at most 1 in 1000


@pytest.mark.parametrize(("count", "height"), [(400, 20.0), (650, 3.0), (1000, 2.0)])
def test_a_sine_in_short_noise_is_a_line(count: int, height: float) -> None:
    """Heights in standard deviations: the fewer lines there are, the less certain is the floor."""
    time = np.arange(count) * 1e-3
    for seed in range(50):
        random = np.random.default_rng((seed, count, 1))
        low = 100.0 / time[-1]
        frequency = random.uniform(1.05 * low, 480.0)
        force = random.normal(size=count) + height * np.sin(2.0 * pi * frequency * time)
        found = strongest_line(st.Record(time=time, force=force), low)
        assert stands_out(found)
        width = 1e4 / count  # of a line
        assert float(found["frequency"].median()) == pytest.approx(frequency, abs=width)


@pytest.mark.parametrize("step", [0.05, 0.1, 0.2])
def test_the_rounding_of_a_sawtooth_has_no_line(step: float) -> None:
    time = np.arange(20_000) * 1e-3
    force = np.rint((0.8 + 0.2 * (time / 0.7 % 1.0)) / step) * step
    found = st.analyse(st.Record(time=time, force=force))
    assert np.isfinite(found.oscillation["frequency"]).mean() < 0.05


@pytest.mark.parametrize(
    "times", [[0.01], np.linspace(0.0, 0.1, 2001) ** 2], ids=["once", "uneven"]
)
def test_uneven_samples_of_a_run_make_no_spectrum_and_no_measurement(times):
    run = st.simulate(st.presets.nakano_popov_2020(), 0.1, times=times)
    for analysis in (st.analysis.transverse_oscillation, lambda its: st.measure(its, st.Sensor())):
        with pytest.raises(st.ResultError, match="sampled once or at uneven times"):
            analysis(run)


@pytest.mark.parametrize("rate", ["10 kHz", "7.3 kHz", None])
def test_a_run_that_was_given_up_has_the_rate_of_its_samples(rate):
    run = st.simulate(st.presets.nakano_popov_2020(), 1.0, sample_rate=rate, max_steps=500)
    assert not run.status.ok
    step = float(np.diff(run.samples["time"])[0])
    assert even_rate(run) == pytest.approx(1.0 / step, rel=2.0 / len(run.samples["time"]))
