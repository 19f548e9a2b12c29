"""How a record stands beside a library: features made comparable, and who stands apart."""

import numpy as np
import pytest

from stiction.inference.learning.expectation import Expectation
from stiction.inference.learning.summary import Standard, estimate
from stiction.inference.learning.typicality import Typicality


def library_of(seed: int, count: int, wide: float):
    """Return records of which a tenth stand far apart, each from all."""
    random = np.random.default_rng(seed)
    found = random.standard_normal((count, 6))
    found[::10] *= wide
    return found


@pytest.fixture(scope="module", params=[1.0, 10.0, 40.0])
def wide(request):
    """How much farther apart the tenth stands."""
    return request.param


@pytest.fixture(scope="module")
def typical(wide):
    """Of records whose first features are their parameters."""
    library = library_of(1, 1000, wide)
    parameters = library[:, :2]
    return Typicality.of(Expectation.of(library, parameters, estimate(library, parameters)))


def test_a_record_beside_a_dense_part_of_the_library_is_unlike_it(typical):
    """By its distance alone it would not be, where a tenth of the library stands far apart."""
    assert typical.farther(np.full((1, 6), 2.5)) < 0.05


def test_records_of_the_library_s_own_kind_are_unlike_as_seldom_as_stated(typical, wide):
    shares = typical.farther(library_of(2, 1000, wide))
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
