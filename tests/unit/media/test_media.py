"""Sound and film of a run."""

import sys
import wave
from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure

import stiction as st
from stiction.cli import main
from stiction.media.encoder import as_gif, palette
from stiction.media.film import (
    FRAME_RATE,
    NAMES,
    Excerpt,
    draw,
    fine_times,
    microscope,
    moving_at,
    series,
    slowness,
    window_times,
)
from stiction.media.scene import HOME, ROOM, Scene, magnification, wall_distance
from stiction.media.sound import LOUD, RATE, audible_speed
from stiction.plotting.page.style import BLUE, GREEN, ORANGE, RED
from stiction.simulation import sample_coarsely

PAPER = st.presets.nakano_popov_2020()


@pytest.fixture(scope="module")
def run():
    return st.simulate(PAPER, 0.05)


def test_sound_is_the_transverse_rate_at_its_true_pitch(run, tmp_path):
    sound = st.listen(run)
    assert (sound.speed, len(sound.samples)) == (1.0, int(0.05 * RATE))
    values = st.simulate(PAPER, 0.05, sample_rate=RATE).samples["v_y"][: len(sound.samples)]
    values = values - values.mean()
    wanted = LOUD * values / np.abs(values).max()
    np.testing.assert_allclose(sound.samples, wanted, atol=1e-5)  # its times differ by rounding
    path = sound.save(tmp_path / "a.wav")
    with wave.open(str(path)) as file:
        assert (file.getframerate(), file.getnchannels(), file.getsampwidth()) == (RATE, 1, 2)
        read = np.frombuffer(file.readframes(file.getnframes()), "<i2")
    np.testing.assert_allclose(read / 32767, sound.samples, atol=1.0 / 32767)
    assert "<audio" in sound._repr_html_()


def test_the_pitch_is_that_of_the_oscillation(run):
    for speed, window in ((1.0, None), (0.5, ("10 ms", "40 ms"))):
        sound = st.listen(run, speed=speed, window=window)
        spectrum = np.abs(np.fft.rfft(sound.samples * np.hanning(len(sound.samples))))
        line = RATE / len(sound.samples)
        heard = np.argmax(spectrum[int(300 / line) :]) * line + int(300 / line) * line
        # omega_y sin(theta), theta above 88 degrees: within half a line of the spectrum and a bit
        assert abs(heard - speed * PAPER.natural_frequencies[1]) < line


def test_what_cannot_be_heard_is_slowed_down():
    slow = st.Description(PAPER, st.Initial(), st.Settings(duration=1.0))
    fast = slow._replace(slider=PAPER.replace(mass="1 mg"))
    assert audible_speed(slow) == 1.0
    pitch = fast.slider.natural_frequencies[1] * audible_speed(fast)
    assert 800.0 < pitch <= 8000.0
    assert audible_speed(slow, "x") == 10.0  # 10 Hz is not heard
    deep = slow._replace(slider=PAPER.replace(k_x="1 mN/m"))
    assert audible_speed(deep, "x") > 100.0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"speed": 1e-9}, "may last up to"),
        ({"speed": 1e9}, "it must last at least 10 ms: choose a smaller speed"),
        ({"speed": -1.0}, "above 0"),
        ({"speed": 10**400}, "speed must be a number such as 0.1"),
        ({"speed": "1x"}, "speed must be a number such as 0.1, is '1x'"),
        ({"axis": "z"}, "axis must be 'x' or 'y', is 'z'"),
        ({"window": ("1 s", "2 s")}, "not a part of the run"),
    ],
)
def test_sound_that_cannot_be(run, options, said, tmp_path):
    with pytest.raises(st.ResultError, match=said):
        st.listen(run, **options)
    with pytest.raises(st.ResultError, match=r"name it .*a\.wav"):
        st.listen(run).save(tmp_path / "a.mp3")


def test_the_scene_shows_the_state(run):
    from matplotlib.figure import Figure

    samples = run.samples
    scene = Scene(Figure().add_subplot(), PAPER, samples)
    at = int(np.argmax(samples["spring_x"]))
    names = ("u_x", "u_y", "slip_x", "slip_y", "slip_speed", "friction", "psi", "X", "spring_x")
    state = {name: float(samples[name][at]) for name in (*names, "normal_load", "sticking")}
    scene.show(state, "now")
    tip = np.subtract(*reversed(scene.force._posA_posB))
    psi = np.radians(state["psi"])
    # the force lies on its circle, against the slip
    np.testing.assert_allclose(tip / np.hypot(*tip), [-np.cos(psi), -np.sin(psi)], atol=1e-9)
    outline = np.subtract(np.transpose(scene.circle.get_data()), scene.force._posA_posB[0])
    radius = np.hypot(*outline.T)
    assert np.hypot(*tip) == pytest.approx(radius[0] * state["friction"] / 2.0, rel=1e-9)
    corners = scene.block.get_xy()[:4]
    assert (np.abs(corners) < np.divide(ROOM, 2)).all()
    away = corners.mean(axis=0) - np.array([0.3, -0.45])
    u = np.array([state["u_x"], state["u_y"]]) * magnification(samples)
    assert np.hypot(*away) == pytest.approx(np.hypot(*u), rel=1e-6)


def test_marks_of_the_plate_pass_below_the_words(run):
    """Among the factors of elongations they read as points: 28 was 28; and 2,800 was 2,·800."""
    ax = Figure().add_subplot()
    scene = Scene(ax, PAPER, run.samples)
    below = scene.artists[: scene.artists.index(scene.marks) + 1]
    words = [each for each in ax.texts if each.get_text()]
    assert len(words) >= 2  # the drive's arrow has none
    assert not {*words} & {*below}
    assert {*words} <= {*scene.artists}
    assert all(each.get_bbox_patch() is not None for each in words)


@pytest.mark.parametrize("seed", range(8))
def test_on_a_grain_the_force_ends_on_the_limit_while_the_mass_slides(seed):
    rng = np.random.default_rng(seed)
    ratio, angle = float(np.exp(rng.uniform(-0.7, 0.7))), float(rng.uniform(-1.5, 1.5))
    slider = PAPER.replace(friction=st.laws.Anisotropic(st.Coulomb(0.3), ratio, f"{angle} rad"))
    samples = st.simulate(slider, 0.05, sample_rate=200.0).samples
    scene = Scene(Figure().add_subplot(), slider, samples)
    state = {name: float(values[-1]) for name, (_, values, _) in samples.columns.items()}
    assert state["slip_speed"] > 0.0
    outline, tip = scene._forces(state)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    along, across = np.abs(turn @ outline.T).max(axis=1)  # 73 points: to 0.1 %
    assert np.hypot(*(turn @ tip / [along, across])) == pytest.approx(1.0, abs=2e-3)


def test_the_scene_turns_with_the_springs_and_shows_dampers_along_their_axes():
    from matplotlib.figure import Figure

    parts = [st.Spring("a", 2e3, 4e4, "30 deg"), st.Spring("b", 3e3, 9e4, "-5 deg")]
    askew = {"c_x": 1.0, "c_y": 3.0, "damping_angle": "40 deg"}
    slider = PAPER.replace(springs=parts, phi="20 deg", **askew)
    samples = st.simulate(slider, 0.02, sample_rate=100.0).samples
    scene = Scene(Figure().add_subplot(), slider, samples)
    names = ("u_x", "u_y", "slip_x", "slip_y", "slip_speed", "friction", "psi", "X", "spring_x")
    last = {name: float(samples[name][-1]) for name in (*names, "normal_load", "sticking")}
    scene.show(last, "now")
    # the far ends of the pistons; the lines of angles is at -phi to X, which points to the right
    ends = [np.transpose(parts[1].get_data())[-1] - [0.3, -0.45] for parts in scene.pistons]
    ways = [np.degrees(np.arctan2(y, x)) for x, y in ends]
    assert np.mod(ways, 180.0) == pytest.approx([40.0 - 20.0, 130.0 - 20.0], abs=1e-9)
    spring = np.diff(np.transpose(scene.spring_x.get_data())[[0, -1]], axis=0)[0]
    turned = np.degrees(np.arctan2(*spring[::-1]))
    assert turned == pytest.approx(-np.degrees(slider.misalignment), abs=1.0)
    assert Scene(Figure().add_subplot(), PAPER, samples).pistons == []


def test_frames_follow_the_time(run):
    three = Excerpt(run.description, np.linspace(0.0, 0.05, 3), 0.02, 1.0)
    frames = list(draw(three, 720))
    assert [frame.shape for frame in (frames[0].copy(), *frames[1:])] == [(720, 1280, 3)] * 3
    first, second = (f.copy() for f in draw(three._replace(times=np.array([0.0, 0.05])), 360))
    assert (first != second).any()
    assert len(sample_coarsely(run.description, np.array([0.0, 0.05]))["time"]) == 2
    assert slowness(2520.0) == "2,520 times slower"
    assert slowness(0.1) == "10 times faster"
    assert slowness(1.0) == "in real time"


@pytest.mark.parametrize(
    ("kind", "height", "size"),
    [("mp4", None, (720, 1280)), ("webm", 540, (540, 960)), ("gif", None, (360, 640))],
)
def test_a_film_has_its_frames(run, kind, height, size, tmp_path):
    av = pytest.importorskip("av")
    film = st.animate(run, length=0.2, window=("10 ms", "40 ms"), kind=kind, height=height)
    path = film.save(tmp_path / f"a.{kind}")
    with av.open(str(path)) as file:
        frames = [frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)]
    count = round(0.2 * FRAME_RATE)
    assert len(frames) == (count if kind != "gif" else (count + 1) // 2)
    assert frames[0].shape == (*size, 3)
    assert f"base64,{'R0lG' if kind == 'gif' else ''}" in film._repr_html_()
    with pytest.raises(st.ResultError, match=r"this film is .*kind=\"(gif|mp4)\"\)"):
        film.save(tmp_path / ("a.mp4" if kind == "gif" else "a.gif"))


def test_a_gif_needs_no_further_package(run, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "av", None)
    window = ("10 ms", "40 ms")
    made = st.animate(run, length=0.1, window=window, kind="gif").save(tmp_path / "a.gif")
    assert made.read_bytes().startswith(b"GIF")
    with pytest.raises(st.ResultError, match=r"mp4 and webm need the package av; .* a gif does"):
        st.animate(run, length=0.1, window=window).save(tmp_path / "a.mp4")


def test_a_gif_keeps_the_hues_of_thin_lines():
    """Both springs were orange: the palette followed the floor and the shades of letters."""
    from PIL import Image

    frame = np.full((200, 400, 3), 240, np.uint8)
    frame[40:] = np.linspace(0, 255, 400)[None, :, None].astype(np.uint8)  # shades of grey
    hues = [tuple(bytes.fromhex(color[1:])) for color in (RED, ORANGE, GREEN, BLUE)]
    for at, hue in enumerate(hues):
        frame[4 + 8 * at : 6 + 8 * at] = hue
    image = Image.open(BytesIO(as_gif([frame], 25))).convert("RGB")
    seen = [image.getpixel((200, 4 + 8 * at)) for at in range(len(hues))]
    nearest = [np.abs(np.subtract(hues, each)).sum(axis=1).argmin() for each in seen]
    assert nearest == [0, 1, 2, 3]


def test_films_that_cannot_be(run, tmp_path):
    with pytest.raises(st.ResultError, match=r"unknown format '.avi'; use .mp4, .webm, .gif"):
        st.animate(run, length=0.1).save(tmp_path / "a.avi")
    with pytest.raises(st.ResultError, match="length must lie"):
        st.animate(run, length=1e4)
    with pytest.raises(st.ResultError, match="kind must be one of"):
        st.animate(run, kind="avi")
    with pytest.raises(st.StictionError) as refused:
        st.animate(run, kind="avi", height=700, window=("1 s", "2 s"))
    for fault in ("kind must be", "height: must be 360, 540, 720,", "is not a part of the run"):
        assert fault in str(refused.value)


def test_both_commands(run, tmp_path, capsys):
    path = run.save(tmp_path / "run.nc")
    for arguments in (
        ("listen", path, "-o", tmp_path / "a.wav", "--window", "10 ms", "40 ms", "--speed", "0.1"),
        ("animate", path, "-o", tmp_path / "a.gif", "--length", "0.1s"),
    ):
        with pytest.raises(SystemExit) as end:
            main([str(each) for each in arguments])
        assert not end.value.code
    text = capsys.readouterr().out
    assert "a.wav: 0.3 s, 10 times slower and deeper" in text
    assert "a.gif" in text


def test_times_and_speeds_that_cannot_be_say_what_they_are(run):
    for call, what in (
        (lambda: st.listen(run, speed=0.0), "speed must be above 0, is 0; 0.1 is ten times slower"),
        (
            lambda: st.listen(run, window=("1", "2 s")),
            "^window: '1' has no unit; write for example",
        ),
        (lambda: st.animate(run, at="99 s"), "99 s is not in the run, 0 s to"),
        (lambda: st.animate(run, at="1 m"), "^at: '1 m' is in m, not a unit of a time"),
    ):
        with pytest.raises(st.ResultError, match=what):
            call()
    still = st.simulate(st.presets.nakano_popov_2020().replace(phi="0 deg"), 2.5)
    with pytest.raises(st.ResultError, match=r"nothing oscillates along y .*; choose the axis x"):
        st.listen(still)
    assert st.listen(still, axis="x").samples.any()


def test_a_slip_slower_than_a_millionth_of_the_drive_is_shown_at_rest():
    """A fault that has just been loaded creeps at 1e-30 m/s, which no axis and no unit suits."""
    law = st.laws.RateStateAgeing(a=0.008, b=0.014, D_c="10 um", mu_star=0.6, V_star="1 um/s")
    rock = st.Slider(
        mass="1 kg", k_x="200 kN/m", k_y="20 MN/m", phi="1 deg", normal_load="5 kN",
        friction=law, drive=st.ConstantVelocity("10 um/s"),
    )  # fmt: skip
    times = np.linspace(0.0, 60.0, 100)
    samples = sample_coarsely(st.simulate(rock, 60.0).description, times)
    assert samples["slip_speed"][-1] < 1e-20
    figure = Figure()
    scene = Scene(figure.add_subplot(), rock, samples)
    state = {name: float(samples[name][-1]) for name in NAMES}
    scene.show(state, "")
    assert scene.words[1].get_text() == "slip speed: at rest"
    assert not scene.slip.get_visible()
    microscope(figure, samples, 1.0)
    assert figure.axes[-1].get_ylabel() == "slip speed (m/s), grey: at rest"
    series(figure, samples, times)
    force, slip = figure.axes[2], figure.axes[-1]
    assert [text.get_text() for text in slip.texts] == ["no slip"]
    assert force.get_ylabel() == "spring force (kN)"  # 209 N
    legend = force.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["$k_y u_y$", "$k_x u_x$"]


def test_an_elongation_that_stays_zero_is_magnified_as_the_other():
    samples = {"u_x": np.array([0.0, 2e-3]), "u_y": np.zeros(2)}
    x, y = magnification(samples)
    assert x == y == pytest.approx(200.0, rel=0.5)


def test_a_film_of_a_short_window_of_a_long_run_shows_it_in_full():
    """Series have the resolution of the window, and the microscope a moment at which it slips."""
    description = st.simulate(st.presets.nakano_popov_2020(), 100.0, multiscale=True).description
    times = np.linspace(2.0, 2.02, 10)
    seen = sample_coarsely(description, window_times(description, times))
    figure = Figure()
    series(figure, seen, times)
    drawn = figure.axes[1].lines[0].get_xdata()
    shown = drawn[(drawn >= times[0]) & (drawn <= times[-1])]
    assert len(np.unique(shown)) > 500
    at = moving_at(seen)
    assert times[0] < at < times[-1]
    assert np.interp(at, seen["time"], seen["slip_speed"]) > 1e-6


def test_a_spring_that_is_loaded_evenly_is_not_heard():
    """The start, which differs by epsilon from the rest, was a click as loud as can be."""
    held = st.simulate(st.presets.nakano_popov_2020(), 0.01)  # the first slip is later
    assert held.data["sticking"].values[1:].all()
    for axis in "xy":  # each was told to choose the other
        with pytest.raises(st.ResultError, match=r"nothing oscillates from .* or run it longer"):
            st.listen(held, speed=1.0, axis=axis)


def test_axes_of_a_film_have_units_and_ticks_that_suit_them():
    """A few microseconds were -0.006 to 0.006 ms from 0.0674 s; labels of ticks ran together."""
    fast = st.presets.nakano_popov_2020().replace(phi="0 deg", k_y="400 GN/m")
    description = st.simulate(fast, 0.2).description
    times = np.linspace(0.0, 0.2, 10)
    seen = sample_coarsely(description, window_times(description, times))
    figure = Figure(figsize=(12.8, 7.2), dpi=100)
    series(figure, seen, times)
    fine = sample_coarsely(description, fine_times(description, 0.0674213))
    microscope(figure, fine, 1.0)
    *strips, small = figure.axes
    assert small.get_xlabel() == "time from 0.0674213 s (µs)"
    assert small.get_xlim() == pytest.approx((-10.0, 10.0), rel=0.1)
    figure.draw_without_rendering()
    for ax in strips:
        labels = [each for each in ax.get_xticklabels() if each.get_text()]
        boxes = [each.get_window_extent() for each in labels]
        assert all(a.x1 + 4 < b.x0 for a, b in pairwise(boxes))
    force, angle, _ = strips
    assert angle.get_ylim() == pytest.approx((-1.0, 1.0), abs=0.1)  # it stays zero
    assert angle.yaxis.label.get_window_extent().x0 > force.get_window_extent().x1


def test_a_film_of_a_run_without_slip_says_so():
    """The axis of the slip speed was empty."""
    description = st.simulate(st.presets.nakano_popov_2020(), "5 ms").description
    times = np.linspace(1e-3, 5e-3, 10)
    figure = Figure(figsize=(12.8, 7.2), dpi=100)
    series(figure, sample_coarsely(description, window_times(description, times)), times)
    assert [text.get_text() for text in figure.axes[2].texts] == ["no slip"]


def test_areas_of_a_gif_keep_their_colours():
    """Grey of rest was pink, the plate green: colours of a palette were means of many."""
    Image = pytest.importorskip("PIL.Image")
    frame = np.full((64, 64, 3), 255, np.uint8)
    frame[:32], frame[40:50] = (245, 244, 240), (217, 217, 217)
    frame[60, :, 0] = np.arange(64)  # hues beside the areas
    small = palette(Image.fromarray(frame))
    found = np.asarray(Image.fromarray(frame).quantize(palette=small, dither=0).convert("RGB"))
    assert (found[:32] == (245, 244, 240)).all()
    assert (found[40:50] == (217, 217, 217)).all()
    assert (found[34:40] == 255).all()


@pytest.mark.parametrize("turn", [0.0, 0.7, 1.5, 3.0, -2.0])
def test_walls_lie_in_the_picture(turn):
    """At 40 degrees that of the soft spring was below it."""
    for angle in (turn, turn + 0.5 * np.pi):
        way = np.array([np.cos(angle), np.sin(angle)])
        assert (np.abs(HOME + wall_distance(way, 3.1) * way) <= 0.5 * np.array(ROOM)).all()
    assert wall_distance(np.array([1.0, 0.0]), 3.1) == pytest.approx(3.1)


def test_a_vibration_of_many_swings_is_a_band_in_a_film():
    """Forces, direction and slip speed were filled areas."""
    fast = st.presets.nakano_popov_2020().replace(drive=st.ConstantVelocity("30 mm/s"), k_x=1e5)
    description = st.simulate(fast, 2.0).description
    times = np.linspace(0.0, 2.0, 10)
    figure = Figure(figsize=(12.8, 7.2), dpi=100)
    series(figure, sample_coarsely(description, window_times(description, times)), times)
    force, _, speed = figure.axes
    assert len(force.collections) > 0
    pale, largest, _ = speed.lines
    assert pale.get_alpha() < 0.5
    assert (largest.get_ydata()[1:] > 1e-3).all()
