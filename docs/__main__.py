"""``uv run --group docs python -m docs``: build the site into docs/_build/html.

Warnings are errors, and so is a script, a style or a font from elsewhere: the site is read without
a network, too. Figures and notebooks that have not changed are not computed again.
"""

import re
import sys
from pathlib import Path

from sphinx.cmd.build import main

HERE = Path(__file__).parent
BUILT = HERE / "_build" / "html"
OUTSIDE = re.compile(r"""(?:src|href)=["'](https?://[^"']+\.(?:m?js|css|woff2?)[^"']*)""")


def load_from_elsewhere(folder: Path) -> list[str]:
    """Return what the pages of a folder load from another host, each with its page."""
    return [
        f"{page.relative_to(folder)} loads {found}"
        for page in sorted(folder.rglob("*.html"))
        for found in OUTSIDE.findall(page.read_text("utf-8"))
    ]


if __name__ == "__main__":
    status = main(["-W", "--keep-going", "-n", "-q", str(HERE), str(BUILT)])
    outside = load_from_elsewhere(BUILT) if status == 0 else []
    print("\n".join(outside), file=sys.stderr)
    sys.exit(status or int(bool(outside)))
