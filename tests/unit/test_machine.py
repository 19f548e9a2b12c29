"""Objects larger than the available memory are refused before they are allocated."""

import numpy as np
import pytest

import stiction as st
from stiction import machine
from stiction.solver.state import Output

BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="5 ms"))


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """On any machine the limit is 1 GB."""
    monkeypatch.setattr(machine, "largest_object", lambda: 1e9)


def fault_of(make) -> str:
    with pytest.raises(st.DescriptionError) as error:
        make()
    return str(error.value)


def test_samples_are_refused_by_their_path(tmp_path):
    text = BASE.to_toml().replace('duration = "5 ms"', 'duration = "5 s"\nsample_rate = "10 MHz"')
    (tmp_path / "a.toml").write_text(text)
    said = fault_of(lambda: st.Description.from_toml(tmp_path / "a.toml"))
    assert said.startswith(
        "run.sample_rate: duration times sample_rate is 5e+07 samples, which takes"
    )
    assert "15 GB of memory, more than the limit of 1 GB on this machine; lower the rate" in said
    assert "run.sample_rate: makes 5e+06 samples in 2 runs" in fault_of(
        lambda: st.compare(BASE._replace(run=st.Settings(duration=25, sample_rate=1e5)), "coulomb")
    )


@pytest.mark.parametrize("kind", [st.Grid, st.Random, st.Sobol])
def test_an_axis_is_refused_before_it_is_made(kind):
    said = fault_of(
        lambda: st.Study(base=BASE, axes={"phi": kind("1 deg", "2 deg", 1_000_000_000)})
    )
    assert "axes.phi.count: 1000000000 values: takes" in said


def test_runs_and_traces_are_refused_before_they_are_laid_out():
    def axes(count):
        return {"phi": st.Grid("1 deg", "2 deg", count), "k_x": st.Grid(1e3, 2e3, count)}

    assert "axes: 100000 x 100000 runs: to count them takes" in fault_of(
        lambda: st.Study(base=BASE, axes=axes(100_000))
    )
    assert "trace_samples: 1 measures, 1 traces of 100000 samples of each run: takes" in fault_of(
        lambda: st.Study(
            base=BASE, axes=axes(10_000), measures=["regime"], traces=["force"],
            trace_samples=100_000,
        )
    )  # fmt: skip


def test_sticks_are_refused_before_there_is_room_for_them():
    out = Output(np.zeros(1), np.zeros((1, 7)), np.zeros((4096, 2)))
    assert out.make_room(4095)
    assert out.make_room(4096)
    assert len(out.sticks) == 8192
    out.sticks = np.zeros((2**23, 2))
    assert not out.make_room(2**23)


def test_a_multiscale_run_ends_before_it_fills_the_memory(monkeypatch):
    """It was thrown away after all of its work, though each end is said to be a status."""
    monkeypatch.setattr(machine, "largest_object", lambda: 1e6)  # room for some thousand sticks
    slow = BASE.slider.replace(drive=st.ConstantVelocity("1 nm/s"))
    for slider, way in ((BASE.slider, True), (slow, "auto"), (slow, False)):
        run = st.simulate(slider, 1e9, times=[0.0, 0.5, 1.0, 1e9], multiscale=way)
        assert run.status is st.Status.TOO_MANY_STICKS
        assert not run.status.ok
        assert run.sticks.sizes["stick"] == 8192
        ends = float(run.data["time"][-1])
        whole = st.simulate(slider, times=[0.0, 0.5, 1.0, ends], multiscale=way)
        end = float(run.sticks["stick_end"][-1])
        assert 0.0 <= ends - end < 1e-2 * end
        assert run.data["u_x"].values == pytest.approx(whole.data["u_x"].values, rel=1e-5)


def test_files_of_others_are_refused_before_they_are_read(tmp_path):
    """They say that they hold 745 GiB: arrays without content take no place on a disk."""
    import h5py

    with h5py.File(tmp_path / "a.nc", "w") as file:
        file.create_dataset("time", (10**11,), "f8", chunks=(10**6,))
    with pytest.raises(st.ResultError, match="reading it takes 800 GB of memory"):
        st.load(tmp_path / "a.nc")


def test_a_store_of_others_is_refused_before_it_is_read(tmp_path):
    import zarr

    study = st.Study(base=BASE, axes={"phi": st.Values(["1 deg"])}, measures=["peak_force"])
    st.sweep(study, tmp_path / "a.zarr")
    group = zarr.open_group(tmp_path / "a.zarr", mode="r+", use_consolidated=False)
    group["phi"].resize((10**11,))
    group.attrs["format"] = 1  # without checksums
    with pytest.raises(st.ResultError, match="reading it takes 800 GB of memory"):
        st.open_study(tmp_path / "a.zarr")


def test_the_limit_is_half_of_the_least_it_says(monkeypatch, tmp_path):
    monkeypatch.undo()
    (tmp_path / "max").write_text("max\n")
    (tmp_path / "some").write_text("2000000000\n")
    monkeypatch.setattr(machine, "_physical", lambda: 3e9)
    monkeypatch.setattr(machine, "_of_process", lambda: float("inf"))
    for file, lent in (("max", 1.5e9), ("none", 1.5e9), ("some", 1e9)):
        monkeypatch.setattr(machine, "LIMITS", (tmp_path / file,))
        assert machine.largest_object.__wrapped__() == lent
