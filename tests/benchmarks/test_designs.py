"""The benchmark of designs: the features that the fit of each test uses."""

from benchmarks.inference.designs import columns_of, plan_of

from stiction.inference.columns import features_from


def test_a_fit_uses_what_its_test_measures_of_each_record():
    trial, tests = plan_of("pin on plate", ("force",), 20, 200)
    conditions, slider = trial.conditions[0], trial.slider
    every = features_from(("force", "force_across", "position"), conditions, slider)
    assert every.all()
    width = len(every)
    force = features_from(("force",), conditions, slider).nonzero()[0].tolist()
    across = features_from(("force", "force_across"), conditions, slider).nonzero()[0].tolist()
    found = dict(zip((test.name for test in tests), columns_of(trial, tests), strict=True))
    assert found["the present test"] == force
    assert found["the force across"] == across
    assert len(across) > len(force)
    # the second, third and last records have their own columns, after those of the first
    assert found["the same test again"] == force + [width + each for each in force]
    assert found["turned by 2 deg"] == force + [2 * width + each for each in force]
    last = len(trial.conditions) - 1
    assert found["under 8 N"] == force + [last * width + each for each in force]
