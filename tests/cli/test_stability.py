"""``stiction stability``, run in this process on real files."""

import re

import pytest

from stiction.cli import main


def inside(*arguments):
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


def rows(text):
    """Return the cells of the last table that was printed."""
    lines = text.split("wrote")[0].split("─")[-1].splitlines()
    return [cells for line in lines if (cells := re.split(r"\s{2,}", line.strip())) != [""]]


@pytest.fixture
def config(tmp_path):
    path = tmp_path / "slider.toml"
    assert inside("init", path) == 0
    return path


def test_modes_and_critical_values_are_printed_and_drawn(config, tmp_path, capsys):
    capsys.readouterr()
    ranges = ["--between", "1 deg", "30 deg", "--between", "0.1 mm/s", "100 mm/s"]
    over = ["--over", "phi", "--over", "drive.velocity"]
    assert inside("stability", config, *over, *ranges, "-o", tmp_path / "map.png") == 0
    text = capsys.readouterr().out
    assert "Steady sliding is unstable: not every disturbance decays." in text
    assert "152.4" in text  # the fastest growth rate
    assert rows(text) == [
        ["phi", "1 deg", "8.65603 deg", "unstable (now)", "10.25 Hz"],
        ["8.65603 deg", "30 deg", "stable"],
        ["drive.velocity", "100 µm/s", "92.1886 mm/s", "unstable (now)", "10.07 Hz"],
        ["92.1886 mm/s", "100 mm/s", "stable"],
    ]
    assert "Now: phi = 1 deg, drive.velocity = 1 mm/s." in text
    assert (tmp_path / "map.png").stat().st_size > 10_000


def test_one_parameter_is_drawn_as_modes(config, tmp_path):
    assert inside("stability", config, "--over", "c_x", "--between", "0", "100",
                  "-o", tmp_path / "modes.svg") == 0  # fmt: skip
    assert "growth rate" in (tmp_path / "modes.svg").read_text()


def test_what_is_wrong_is_said_in_one_line(config, capsys):
    capsys.readouterr()
    assert inside("stability", config, "--over", "drive.speed") == 2
    assert "unknown parameter 'drive.speed'" in capsys.readouterr().err
    assert inside("stability", config, "--over", "phi", "--between", "0 deg", "3 m") == 2
    assert "not a unit of an angle" in capsys.readouterr().err
    assert inside("stability", config, "--between", "0 deg", "3 deg") == 2
    assert "--between as often or not at all, not 2 and 1 times" in capsys.readouterr().err


def test_a_range_may_begin_below_zero(config, capsys):
    assert inside("stability", config, "--over", "phi", "--between", "-10 deg", "10 deg") == 0
    found = rows(capsys.readouterr().out)
    assert [row[-2:] for row in found] == [
        ["stable", "10.25 Hz"],
        ["unstable (now)", "10.25 Hz"],
        ["10 deg", "stable"],
    ]


def test_joined_parameters_of_different_values_are_nowhere_now(config, capsys):
    assert inside("stability", config, "--over", "k_x, k_y", "--between", "1e3", "1e6") == 0
    assert "now" not in capsys.readouterr().out.lower()


def test_a_usual_range_that_is_not_allowed_says_so(config, capsys):
    law = 'law = "rate-and-state-ageing"\na = 0.01\nb = 0.015\nD_c = "10 um"\n'
    text = config.read_text().split("[friction]")[0] + "[friction]\n" + law
    text += 'mu_star = 0.2\nV_star = "1 mm/s"\n[drive]\nvelocity = "1 mm/s"\n'
    config.write_text(text)
    assert inside("stability", config, "--over", "friction.a") == 2
    assert "the usual range, 1e-05 to 10.0, is not allowed; give another" in capsys.readouterr().err


def test_the_verdict_and_the_ranges_agree(tmp_path, capsys):
    """Of a rock whose fastest modes decay at 3e8 per second, and slowest at 0.06."""
    path = tmp_path / "rock.toml"
    path.write_text(
        '[slider]\nmass = 1\nk_x = 2e5\nk_y = 2e7\nphi = "1 deg"\nnormal_load = 5e3\n'
        '[friction]\nlaw = "rate-and-state-ageing"\na = 0.008\nb = 0.006\nD_c = 1e-5\n'
        "mu_star = 0.6\nV_star = 1e-6\n[drive]\nvelocity = 1e-5\n"
    )
    assert inside("stability", path, "--over", "friction.b", "--between", "0.005", "0.007") == 0
    text = capsys.readouterr().out
    assert "Steady sliding is stable: every small disturbance decays." in text
    assert rows(text) == [["friction.b", "0.005", "0.007", "stable (now)"]]


def test_what_neither_grows_nor_decays_is_said(config, capsys):
    text = config.read_text().replace('law = "exponential-weakening"', 'law = "coulomb"')
    lines = [line for line in text.splitlines() if not line.startswith(("mu_inf", "v_f"))]
    config.write_text("\n".join(lines).replace('phi = "1 deg"', 'phi = "0 deg"'))
    assert inside("stability", config, "--over", "mass") == 0
    text = capsys.readouterr().out
    assert "on the boundary of stability" in text
    assert "within its uncertainty (now)" in " ".join(text.split())
