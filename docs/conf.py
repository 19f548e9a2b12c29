"""How the site is built: `uv run --group docs python -m docs`."""

import sys
from importlib import metadata
from pathlib import Path

import stiction

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "extensions"), str(HERE.parent)]  # verification cases: benchmarks
sys.argv[0] = "stiction"  # by which usage lines of subcommands name the program

# the gallery files a function under the shortest name that it finds, and old names work for a while
vars(stiction)["_RENAMED"].clear()

project = "stiction"
author = "The stiction developers"
copyright = "the stiction developers, MIT license"
version = release = metadata.version("stiction")

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "cyclopts.ext.sphinx",
    "myst_nb",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinx-mathjax-offline",  # equations without a network
    "description_tables",
    "links",
]
exclude_patterns = ["_build", "gallery/**", "auto_gallery/**.ipynb"]
nitpicky = True
default_role = "name"
templates_path = ["_templates"]
suppress_warnings = ["config.cache", "mystnb.unknown_mime_type"]

html_theme = "pydata_sphinx_theme"
html_title = "stiction"
html_static_path = []
html_theme_options = {
    "navbar_align": "left",
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
}

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_output_stderr = "remove"  # progress and compilation, which depend on the machine

autodoc_typehints = "none"
PYTHON = "reference/python"
autosummary_generate = [f"{PYTHON}/{page.name}" for page in (HERE / PYTHON).glob("*.md")]
autosummary_imported_members = False
napoleon_google_docstring = False
napoleon_preprocess_types = True
napoleon_use_rtype = False


def legible(_, __):
    """Set colours that the colour-blind distinguish, and small type."""
    import matplotlib as mpl
    from cycler import cycler

    mpl.rcParams.update(
        {
            "axes.prop_cycle": cycler(
                color=["#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7", "#000000"]
            ),
            "font.size": 9.0,
            "legend.frameon": False,
            "savefig.dpi": 120,
        }
    )


PARTS = ["paper", "friction", "protocols", "maps", "apparatus", "inference"]
sphinx_gallery_conf = {
    "write_computation_times": False,  # a page with scripts from elsewhere
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "subsection_order": [f"gallery/{part}" for part in PARTS],
    "within_subsection_order": "FileNameSortKey",
    "reset_modules": ("matplotlib", legible),
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_memory": False,
    "doc_module": ("stiction",),
    "reference_url": {"stiction": None},  # names in scripts are links, too
    "backreferences_dir": f"{PYTHON}/backreferences",
    "min_reported_time": 1e9,
    "abort_on_example_error": True,
    "image_scrapers": ("matplotlib",),
}
