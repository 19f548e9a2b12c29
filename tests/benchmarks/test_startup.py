"""What a user waits for: what the benchmark starts is there."""

import pytest
from benchmarks.speed import startup


def test_it_installs_the_package_itself():
    assert 'name = "stiction"' in (startup.ROOT / "pyproject.toml").read_text("utf-8")


def test_a_command_that_fails_says_what_it_said():
    assert startup.time_command([*startup.STICTION, "--help"]).wall > 0.0
    with pytest.raises(startup.Failed, match="see stiction --help"):
        startup.time_command([*startup.STICTION, "no-such-command"])
