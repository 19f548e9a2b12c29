"""The summary below the table of numbers counts what is listed above it."""

from stiction.presets import Number
from stiction.reproduction.numbers import NumberTable


def test_findings_are_counted_among_the_numbers_listed():
    agreeing = [Number("Fig. 3", f"number {i}", 1.0, 1.0, 0.1) for i in range(3)]
    findings = [
        Number("Eq. (8)", "as printed", 1.0, 0.5, 0.1, finding=True),
        Number("Results", "time at full stop", 0.0, 7.0, 0.0, finding=True),
    ]
    own = [Number("reference", "period", 0.9, 0.9, 0.1)]
    assert NumberTable([*agreeing, *findings, *own]).summary == (
        "3 of 5 of the paper's numbers agree; 1 of 1 reference values of this project agree; "
        "2 are findings: Eq. (8) as printed, Results time at full stop"
    )
    assert NumberTable([*agreeing, findings[0]]).summary == (
        "3 of 4 of the paper's numbers agree; 1 is a finding: Eq. (8) as printed"
    )
