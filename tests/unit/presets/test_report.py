"""Presets in words, and as files to start from."""

import pytest

import stiction as st
from stiction.presets import PRESETS, find
from stiction.presets.report import comparison, overview, story


def test_the_overview_has_each_preset_once_and_marks_scenarios():
    published, scenarios = overview()
    names = [row[0] for part in (published, scenarios) for row in part.table.rows]
    assert sorted(names) == sorted(PRESETS)
    assert {row[0] for row in scenarios.table.rows} == {
        name for name, each in PRESETS.items() if each.grade == "scenario"
    }
    years = [row[1].split()[-1] for row in published.table.rows]
    assert years[0] == "1930"


def test_a_story_has_source_assumptions_and_numbers():
    text = "\n".join(map(str, story(find("paper-on-paper"))))
    for words in ("Phys. Rev. E 49", "scenario", "mass 0.5 kg", "removes it", "holds"):
        assert words in text


def test_a_comparison_counts_what_agrees():
    preset = find("modelica-force")
    section = comparison(preset.numbers(st.run(preset.make())))
    assert section.sentences == ["1 of 1 agree."]
    assert section.table.rows[0][-1] == "agrees"


@pytest.mark.parametrize("name", ["leine-belt", "friction-force-microscope"])
def test_init_writes_a_preset_to_edit(tmp_path, name):
    path = st.init(tmp_path / "my.toml", preset=name)
    assert path.read_text().startswith(f"# {name}: ")
    assert st.Description.from_toml(path) == find(name).make()
    with pytest.raises(st.StictionError, match="exists already"):
        st.init(path, preset=name)
