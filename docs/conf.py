# SPDX-License-Identifier: GPL-3.0-or-later
"""Configuration of the site that scripts/docs builds. The source is the whole tree, so that every link of a page also
works where the Markdown file lies; the pages are those of docs/, the examples and a few at the top."""

import pathlib
import re

root = pathlib.Path(__file__).resolve().parent.parent

project = "Boba"
author = "The Boba developers"
copyright = "the Boba developers, GPL-3.0-or-later"
release = re.search(r'"([0-9.]+)"', (root / "python/boba/_version.py").read_text()).group(1)
version = release

extensions = ["myst_parser"]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
root_doc = "docs/index"
include_patterns = ["docs/*.md", "docs/*/*.md", "examples/*/*.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"]
exclude_patterns = ["build", "out", ".git", ".cache", "bench", "bpm", "tests", "docs/static"]
source_suffix = {".md": "markdown"}
# Scenes, Python and shell are coloured; blocks without a language are output.
highlight_language = "text"

html_theme = "furo"
html_title = f"Boba {release}"
html_theme_options = {"navigation_with_keys": True}
html_static_path = ["static", "/usr/share/javascript/katex"]
html_css_files = ["katex.min.css", "boba.css"]
html_js_files = [("katex.min.js", {"defer": "defer"}), ("equations.js", {"defer": "defer"})]
html_math_renderer = "katex"
html_copy_source = False
html_show_sourcelink = False
# The excerpts below search results are fetched, which browsers refuse for pages that are opened from a folder.
html_show_search_summary = False
# Both kinds of quotes stay as they were typed: commands are copied from these pages.
smartquotes = False

# The page of the site's folder leads to its start.
FORWARD = '<!DOCTYPE html><meta charset="utf-8"><title>Boba</title><meta http-equiv="refresh" content="0; url=docs/index.html">'


def inline_equation(self, node):
    self.body.append(self.starttag(node, "span", "", CLASS="equation") + self.encode(node.astext()) + "</span>")
    raise_skip()


def displayed_equation(self, node):
    self.body.append(self.starttag(node, "div", "", CLASS="equation displayed"))
    self.body.append(self.encode(node.astext()) + "</div>")
    raise_skip()


def raise_skip():
    from docutils import nodes

    raise nodes.SkipNode


def write_forward(app, exception):
    if exception is None and app.builder.name == "html":
        (pathlib.Path(app.outdir) / "index.html").write_text(FORWARD + "\n")


def setup(app):
    from pygments.lexers.special import TextLexer

    app.add_lexer("layers", TextLexer)  # the table that check-dependencies reads
    app.add_html_math_renderer("katex", (inline_equation, None), (displayed_equation, None))
    app.connect("build-finished", write_forward)
