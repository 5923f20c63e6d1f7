"""How the pages of docs/ become a site: `make docs`."""

from __future__ import annotations

import importlib
import re
import sys
import tomllib
from pathlib import Path

from pydantic import BaseModel

import disc_model

project = "disc_model"
author = "The disc_model authors"
copyright = author
release = disc_model.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "numpydoc"]
extensions += ["sphinx-mathjax-offline"]  # formulas are set without a network
exclude_patterns = ["_build", "measurements/*"]
root_doc = "index"

# ---- pages
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"  # a change of the package changes what cells print
# kernels may have to be compiled first, on a machine that does other things too
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_execution_show_tb = True

# ---- docstrings: a single backtick links where there is something to link to
default_role = "py:obj"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_attributes_as_param_list = True
python_maximum_signature_line_length = 80

# ---- the look
html_theme = "furo"
html_title = f"disc_model {release}"
html_show_sphinx = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_with_keys": True}

# ---- addresses, of what is published
_PYPROJECT = Path(__file__).parents[1] / "pyproject.toml"
_ADDRESSES = tomllib.loads(_PYPROJECT.read_text(encoding="utf-8"))["project"].get("urls", {})
html_baseurl = _ADDRESSES.get("Documentation", "")
if "Repository" in _ADDRESSES:
    html_theme_options["source_repository"] = _ADDRESSES["Repository"]
    html_theme_options["source_branch"] = "main"
    html_theme_options["source_directory"] = "docs/"

# ---- `make linkcheck`
linkcheck_timeout = 20
linkcheck_ignore = [r"https?://(dx\.)?doi\.org/"]  # publishers turn away what is no browser


# ---- extensions of Sphinx of our own


def short_signature(app, what, name, thing, options, signature, returns):
    """Return the signature of a pydantic model with names and defaults only.

    Its rules stand in the list of parameters. The arguments are those of Sphinx's event
    ``autodoc-process-signature``.
    """
    if what != "class" or not issubclass(thing, BaseModel):
        return None
    arguments = []
    for field_name, field in thing.model_fields.items():
        if field.is_required():
            arguments.append(field_name)
        else:
            arguments.append(f"{field_name}={field.default!r}")
    return f"({', '.join(arguments)})", returns


def words_below_names(app, what, name, thing, options, lines):
    """Put what a docstring says of a parameter below its name.

    Docstrings say "name : what it is", where numpydoc expects a type. The arguments are those of
    Sphinx's event ``autodoc-process-docstring``.
    """
    changed = []
    for line in lines:
        changed += re.sub(r"^(\w[\w, ]*) : (.*)$", r"\1\n    \2", line).split("\n")
    lines[:] = changed


def write_options(app):
    """Write the page of all options of quantities, which is not stored."""
    sys.path.insert(0, str(app.srcdir))
    page = importlib.import_module("write_options").page_text()
    Path(app.srcdir, "study_options.md").write_text(page, encoding="utf-8")


def setup(app):
    """Connect these functions with Sphinx."""
    app.connect("builder-inited", write_options)
    app.connect("autodoc-process-signature", short_signature)
    app.connect("autodoc-process-docstring", words_below_names, priority=400)  # before numpydoc
