"""``uv run --group docs python -m docs``: build the site into docs/_build/html.

Warnings are errors. Figures and notebooks that have not changed are not computed again.
"""

import sys
from pathlib import Path

from sphinx.cmd.build import main

HERE = Path(__file__).parent

sys.exit(main(["-W", "--keep-going", "-n", "-q", str(HERE), str(HERE / "_build" / "html")]))
