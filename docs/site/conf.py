"""The documentation as an offline site with search: the same Markdown, by Sphinx (target kith_site)."""

import re

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
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_search_summary = False  # browsers do not let a file read others
html_show_copyright = False


def pages_in(text):
    """The pages that a text links to, without decisions and pages of other folders that are no part of the site."""
    return [page for page in re.findall(r"\]\(([^)#]+)\.md", text) if not page.startswith(("adr/", "../web/"))]


def toctree(caption, pages):
    return "\n".join(["", "```{toctree}", ":hidden:", ":glob:", f":caption: {caption}", "", *pages, "```", ""])


def add_contents(app, name, source):
    """What the navigation shows: the list on the first page, and the pages that it names."""
    if name != root_doc:
        return
    known, contents = {"../README"}, toctree("Start here", ["../README"])
    for caption, text in re.findall(r"^\* \*\*(.+?)\*\*:((?: .*\n)+)", source[0], re.M):
        pages = [page for page in pages_in(text) if page not in known]
        known.update(pages)
        if pages:
            contents += toctree(caption, pages)
    rest = sorted(set(pages_in(source[0])) - known)
    source[0] += contents + toctree("To look things up", rest)
    source[0] += toctree("Decisions", ["adr/*"])


# What CMake adds to the site beside the pages: its tag, the page that leads there, before which text, and the sentence.
ADDED = [("api", "docs/library", "## ", 'The <a href="../api/index.html">reference</a> has every class and function.'),
         ("commands", "docs/README", "To look", 'Every <a href="../commands/index.html">command</a> has a page.')]


def add_reference(app, name, source):
    """Leads to what Doxygen and the program say of themselves, where they were asked."""
    for tag, page, before, sentence in ADDED:
        if name == page and tags.has(tag):
            source[0] = source[0].replace(f"\n{before}", f"\n{sentence}\n\n{before}", 1)


def setup(app):
    app.connect("source-read", add_contents)
    app.connect("source-read", add_reference)
