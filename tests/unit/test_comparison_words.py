"""Words of a comparison of friction laws."""

import pytest

from stiction.comparison import share_in_words


@pytest.mark.parametrize(
    ("lasts", "said"),
    [
        (2000.0, "2000 s"),
        (2000.0 - 7e-15, "2000 s"),
        (2000.0 - 1e-9, "2000 s"),
        (1999.84, "all but 160 ms"),
        (1500.0, "1500 s"),
    ],
)
def test_a_stick_is_not_rounded_up_to_the_whole(lasts, said):
    """With slips of 2 mm the mass was stuck "2000 s" of 2000 s."""
    assert share_in_words(lasts, 2000.0) == said
