"""How a record stands beside a library: features made comparable, and who stands apart."""

import numpy as np
import pytest

from stiction.inference.learning.summary import Standard, nearest, outlier_factor


def library_of(seed: int, count: int, wide: float):
    """Return records of which a tenth stand far apart, each from all."""
    random = np.random.default_rng(seed)
    found = random.standard_normal((count, 6))
    found[::10] *= wide
    return found


def share_beyond(library, records):
    """Return the share of the library that stands farther apart from others than each record."""
    apart = nearest(library, library)
    own, its = (outlier_factor(each, library, apart) for each in (library, records))
    return (own > its[:, None]).mean(axis=1)


@pytest.mark.parametrize("wide", [1.0, 10.0, 40.0])
def test_a_record_beside_a_dense_part_of_the_library_is_unlike_it(wide):
    """By its distances alone nothing was, where a tenth of the library stands farther apart."""
    library = library_of(1, 1500, wide)
    beside = np.full((1, 6), 3.5)
    assert share_beyond(library, beside) < 0.05
    if wide > 10.0:
        distances = (nearest(library, library) > nearest(beside, library)).mean()
        assert distances > 0.05


@pytest.mark.parametrize("wide", [1.0, 10.0, 40.0])
def test_records_of_the_library_s_own_kind_are_unlike_as_seldom_as_stated(wide):
    shares = share_beyond(library_of(1, 1500, wide), library_of(2, 1000, wide))
    assert (shares < 0.05).mean() == pytest.approx(0.05, abs=0.03)  # three deviations of both


def test_few_records_far_out_do_not_change_how_the_others_compare():
    random = np.random.default_rng(3)
    features = random.standard_normal((1000, 2))
    before = Standard.of(features).scores(features[20:])
    features[:20] += 1e3
    after = Standard.of(features).scores(features[20:])
    assert np.abs(after - before).max() < 0.2
    constant = np.column_stack([features[:, 0], np.full(1000, 2.0)])
    assert (Standard.of(constant).scores(constant)[:, 1] == 0.0).all()
