"""The documentation as an offline site with search: the same Markdown, by Sphinx (target kith_site)."""

project = "kith"
author = "the authors of kith"
extensions = ["myst_parser"]
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "THIRD_PARTY.md", "docs/*.md", "docs/adr/*.md",
                    "docs/examples/*.md"]
root_doc = "docs/README"
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "ref.myst", "misc.highlighting_failure"]  # links to files of the tree, which is not installed
highlight_language = "none"
html_theme = "alabaster"
html_theme_options = {"description": "Teaches a robot's policy to a group of people", "page_width": "1100px",
                      "font_family": "sans-serif", "show_powered_by": False}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_copy_source = False
html_show_copyright = False

CONTENTS = """

```{toctree}
:hidden:
:glob:

../README
*
../CONTRIBUTING
../CHANGELOG
../THIRD_PARTY
adr/*
```
"""


def add_contents(app, name, source):
    if name == root_doc:
        source[0] += CONTENTS


def setup(app):
    app.connect("source-read", add_contents)
