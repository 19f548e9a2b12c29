"""A system is given as a slider, a description or its file, wherever one is asked for."""

import numpy as np
import pytest

import stiction as st

SLIDER = st.presets.nakano_popov_2020()
DESCRIBED = st.Description.of(SLIDER, "20 ms", initial=st.Initial(u_x="1 um"), sample_rate="2 kHz")


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "rig.toml"
    file.write_text(DESCRIBED.to_toml())
    return file


def test_simulate_takes_a_description_or_its_file_with_their_start(path):
    start = DESCRIBED.initial
    plain = st.simulate(SLIDER, "10 ms", initial=start, sample_rate="1 kHz")
    for given in (DESCRIBED, path, str(path)):
        run = st.simulate(given, "10 ms", sample_rate="1 kHz")
        assert np.array_equal(run.samples["u_x"], plain.samples["u_x"])
    other = st.simulate(DESCRIBED, "10 ms", initial=st.Initial(), sample_rate="1 kHz")
    assert other.samples["u_x"][0] == 0.0


def test_simulate_of_a_description_asks_for_a_duration_and_names_run(path):
    for given in (DESCRIBED, path):
        with pytest.raises(st.DescriptionError, match=r"duration: is missing; .*st\.run"):
            st.simulate(given)
    with pytest.raises(st.DescriptionError, match="is not a Slider"):
        st.simulate(3.0, "1 s")


def test_compare_takes_a_slider_with_a_duration(path):
    found = st.compare(SLIDER, ["coulomb"], duration="5 ms")
    assert [float(each.samples["time"][-1]) for each in found.values()] == [0.005] * 2
    shorter = st.compare(path, ["coulomb"], duration="5 ms")
    assert [float(each.samples["time"][-1]) for each in shorter.values()] == [0.005] * 2
    assert len(shorter["coulomb"].samples["time"]) == 11  # its own sample rate is unchanged


def test_theory_takes_text_with_units_and_bare_angles_in_radians(path):
    phi, told = np.radians(1.0), st.theory.creep_velocity("1 s", "1 mm/s", "1 deg", l_x="2 mm")
    assert told == pytest.approx(float(st.theory.creep_velocity(1.0, 1e-3, phi, 2e-3)), rel=1e-12)
    two = st.theory.creep_velocity(["500 ms", "1 s"], "1 mm/s", phi, 2e-3)
    assert np.allclose(two, st.theory.creep_velocity([0.5, 1.0], 1e-3, phi, 2e-3), rtol=1e-12)
    own = st.theory.damping_number_of(SLIDER, 1e-3)
    for given in (SLIDER, DESCRIBED, path):
        assert st.theory.damping_number_of(given, "1 mm/s") == pytest.approx(own, rel=1e-12)
    with pytest.raises(st.DescriptionError, match=r"V: .*m/s"):
        st.theory.damping_number_of(SLIDER, "1 mm")


def test_plots_and_onsets_take_descriptions(path):
    ax = st.plotting.plot_law(path, "20 mm/s")
    assert ax.get_xlim()[1] == pytest.approx(20.0)
    with pytest.raises(st.DescriptionError, match="fastest"):
        st.plotting.plot_law(SLIDER, "20 mm")


def test_figures_and_stability_take_a_description_or_its_file(path):
    stability = st.linear_stability
    critical = stability.critical(SLIDER, "phi", points=9)
    curve = stability.boundary(SLIDER, "phi", "drive.velocity")
    modes = stability.modes_over(SLIDER, "phi", points=5)
    for given in (DESCRIBED, path, str(path)):
        assert stability.critical(given, "phi", points=9) == critical
        assert stability.boundary(given, "phi", "drive.velocity").identical(curve)
        assert stability.modes_over(given, "phi", points=5).identical(modes)
        assert stability.steady_sliding(given).slider == SLIDER
        assert stability.growth_rate(given) == stability.growth_rate(SLIDER)
        assert st.plotting.plot_slider(given).get_title() == ""
    for function in (stability.steady_sliding, stability.growth_rate, st.plotting.plot_slider):
        with pytest.raises(st.DescriptionError, match="float is not a description"):
            function(3.0)


def test_apparent_friction_takes_the_description_that_was_swept(tmp_path):
    base = st.Description.of(SLIDER, "20 ms")
    done = st.sweep(st.protocols.yaw_sweep(base, ["1 deg", "12 deg"]), tmp_path / "angles.zarr")
    study = st.open_study(done.store)
    plain = st.analysis.apparent_friction(study, SLIDER)
    assert np.array_equal(st.analysis.apparent_friction(study, base).steady, plain.steady)


@pytest.mark.parametrize("value", [None, {}, True, [1e-3, 2e-3], [1e-3, "2 mm/s"]])
@pytest.mark.parametrize("name", ["V", "phi"])
def test_what_is_no_single_quantity_is_refused_by_name(name, value):
    if name == "phi" and value is None:
        return  # the slider's own
    given = {"V": 1e-3, name: value}
    with pytest.raises(st.DescriptionError, match=rf"^{name}: must be one number"):
        st.theory.damping_number_of(st.presets.nakano_popov_2020(), **given)
