"""A rig and records in each other's place are recognised, whatever they are."""

import pytest

import stiction as st

SLIDER = st.presets.nakano_popov_2020()
TOML = SLIDER.to_toml().replace('phi = "1.0 deg"', 'phi = "1 +- 0.5 deg"')


@pytest.fixture(params=["path", "text", "value"])
def both(request, tmp_path):
    """A rig, and a record in an encoding that no description has."""
    rig, record = tmp_path / "rig.toml", tmp_path / "A.txt"
    rig.write_text(TOML)
    record.write_bytes("Zeit (s);Kraft (µN)\n0,0;1,0\n0,1;2,0\n".encode("latin-1"))
    if request.param == "path":
        return rig, record
    if request.param == "text":
        return str(rig), str(record)
    return st.Rig.from_toml(rig), st.Record(time=[0.0, 0.1, 0.2], force=[0.0, 1.0, 2.0])


@pytest.mark.parametrize("name", ["fit", "mechanism"])
def test_a_rig_before_its_records_is_answered_by_their_order(both, name):
    rig, record = both
    for records in (record, [record]):
        with pytest.raises(st.DescriptionError) as refused:
            getattr(st, name)(rig, records)
        assert str(refused.value) == f"the rig comes second: st.{name}(records, rig)"


def test_a_record_before_its_rig_is_answered_by_their_order(both):
    rig, record = both
    for call, told in (
        (st.audit, "the rig comes first: st.audit(rig, record=record)"),
        (st.design, "the rig comes first: st.design(rig, record)"),
    ):
        with pytest.raises(st.DescriptionError) as refused:
            call(record, rig)
        assert str(refused.value) == told
