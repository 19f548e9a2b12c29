"""The worked examples of CONTRIBUTING.md, built from its text and used."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import stiction

ROOT = Path(__file__).parents[2]
PACKAGE = Path(stiction.__file__).parent
# where it goes, "a line in NAME of" before it for a registry; then the text itself
BLOCK = re.compile(
    r"(?:line in (?:`(?P<name>\w+)` of )?|In )`src/(?P<path>[\w/.]+)`:\n\n"
    r"```python\n(?P<text>.*?)```",
    re.DOTALL,
)
USES = r"""
import sys
import stiction as st
from stiction.analysis.export import numbers
from stiction.friction import LAWS
from stiction.testing import check_law

paper = st.presets.nakano_popov_2020()
check_law(LAWS["viscous"](0.2, "1 m/s"))
st.init("my.toml")
assert '# law = "viscous"' in open("my.toml").read()
run = st.simulate(paper, 0.02, sample_rate="10 kHz")
assert len(st.plotting.plot_phase_plane(run).lines) == 1
found = st.analyse(run)
assert "Fall\n  The force falls by up to " in str(found)
assert numbers(found)["fall"] == {"rate": found.parts["fall"], "unit": "N/s"}
base = st.Description(paper, st.Initial(), st.Settings(duration=1.5))
study = st.Study(base=base, axes={"V": st.Values(["5 mm/s"])}, measures=["largest_drop"])
st.sweep(study, "my.zarr")
assert float(st.open_study("my.zarr")["largest_drop"].squeeze()) > 0.1
from stiction.cli import main
main(["frequencies", "my.toml"])
"""


def lay_out(package: Path) -> int:
    """Put what the page tells into a copy of the package; return how many pieces there were."""
    page = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    blocks = list(BLOCK.finditer(page))
    for block in blocks:
        path = package.parent / block["path"]
        if not path.exists():
            path.write_text(block["text"])
            continue
        lines = path.read_text().splitlines(keepends=True)
        if block["name"] is None:
            place = max(i for i, line in enumerate(lines) if line.startswith("from stiction"))
        else:
            place = next(i for i, line in enumerate(lines) if line.startswith(block["name"]))
        lines.insert(place + 1, block["text"])
        path.write_text("".join(lines))
    return len(blocks)


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    copy = tmp_path_factory.mktemp("source") / "stiction"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    assert lay_out(copy) == 9
    return copy


def test_what_is_added_works(package, tmp_path):
    # in plain Python: compiled, a changed package would leave machine code behind for nobody
    plain = {"PYTHONPATH": str(package.parent), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", USES],
        cwd=tmp_path,
        env=os.environ | plain,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "10.07 Hz and 1007 Hz" in done.stdout
