"""What the site adds to Sphinx: generated parts, formulas as MathML, a check of all local links."""

import re
from collections.abc import Iterable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import pypandoc
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from docs.generators import filled, names

_BREAK = "PLATECONTACTBREAK"
_BARS = re.compile(r"(?<![\\`|])\|([^\s|][^|]*)\|(?!`)")
_MATH = re.compile(r"<math.*?</math>", re.DOTALL)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the hooks."""
    app.connect("source-read", fill)
    app.connect("autodoc-process-docstring", escape_bars, priority=900)  # after numpydoc
    app.connect("doctree-resolved", convert_formulas)
    app.connect("build-finished", check_site)
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def fill(_app: Sphinx, _name: str, source: list[str]) -> None:
    """Put the generated parts into a page."""
    source[0] = filled(source[0])


def escape_bars(
    _app: Sphinx, _kind: str, _name: str, _value: Any, _options: Any, lines: list[str]
) -> None:
    """Keep the bars of absolute values, which mark substitutions in reStructuredText."""
    lines[:] = [line if line.startswith("  ") else _BARS.sub(r"``|\1|``", line) for line in lines]


def convert_formulas(_app: Sphinx, tree: nodes.document, _name: str) -> None:
    """Convert all formulas of a page in one call of pandoc.

    Raises
    ------
    ExtensionError
        If pandoc cannot read a formula.
    """
    formulas = [*tree.findall(nodes.math), *tree.findall(nodes.math_block)]
    if not formulas:
        return
    pieces = [
        f"${node.astext()}$" if isinstance(node, nodes.math) else f"$${node.astext()}$$"
        for node in formulas
    ]
    text = f"\n\n{_BREAK}\n\n".join(pieces)
    page = pypandoc.convert_text(text, "html5", format="latex", extra_args=["--mathml"])
    for node, part in zip(formulas, page.split(_BREAK), strict=True):
        formula = _MATH.search(part)
        if formula is None:
            raise ExtensionError(f"no MathML for the formula {node.astext()}")
        node["mathml"] = formula[0]


def visit_math(writer: Any, node: nodes.math) -> None:
    """Write a formula in a line of text."""
    writer.body.append(node["mathml"])
    raise nodes.SkipNode


def visit_block(writer: Any, node: nodes.math_block) -> None:
    """Write a formula of its own."""
    writer.body.append(f'<div class="math">{node["mathml"]}</div>\n')
    raise nodes.SkipNode


class _Page(HTMLParser):
    """Targets and links of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.ids, self.links, self.loads = set[str](), list[str](), list[str]()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect what the tag defines, links and loads."""
        given = {key: value for key, value in attrs if value}
        self.ids |= {given[key] for key in ("id", "name") if key in given}
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if "src" in given:
            self.loads.append(given["src"])
        if tag == "link" and given.get("rel") in ("stylesheet", "preload", "icon"):
            self.loads.append(given["href"])


def problems(site: Path) -> Iterator[str]:
    """Yield each local link without a target, and each file that is loaded from elsewhere."""
    pages = {path.resolve(): _Page(path) for path in sorted(site.rglob("*.html"))}
    for path, page in pages.items():
        if "_static" in path.parts:
            continue
        where = path.relative_to(site.resolve())
        for load in page.loads:
            if urlsplit(load).netloc:
                yield f"{where}: loads {load} from another site"
        for link in (*page.links, *page.loads):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                yield f"{where}: {link} leads to no file"
            elif parts.fragment and target in pages:
                anchor = unquote(parts.fragment)
                if anchor not in pages[target].ids:
                    yield f"{where}: {link} leads to no place on the page"


def far(site: Path, anchors: Iterable[str]) -> Iterator[str]:
    """Yield each anchor that takes more than two clicks from the start page."""
    start = (site / "index.html").resolve()
    near = {target for target, _ in _targets(start)} | {start}
    pages = [page for page in near if page.suffix == ".html" and page.is_file()]
    reached = {anchor for page in pages for _, anchor in _targets(page)}
    reached |= {anchor for page in pages for anchor in _Page(page).ids}
    yield from (f"{anchor}: more than two clicks" for anchor in anchors if anchor not in reached)


def _targets(path: Path) -> Iterator[tuple[Path, str]]:
    """Yield the file and the anchor of each local link of a page."""
    for link in _Page(path).links:
        parts = urlsplit(link)
        if not parts.scheme and not parts.netloc:
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            yield target, unquote(parts.fragment)


def check_site(app: Sphinx, error: Exception | None) -> None:
    """Check the links of the finished site, and that each name is two clicks away at most.

    Raises
    ------
    ExtensionError
        If a local link has no target, a page loads a file from another site, or a name is too far.
    """
    if error is None and app.builder.name == "html":
        site = Path(app.outdir)
        broken = [*problems(site), *far(site, names.anchors())]
        if broken:
            raise ExtensionError("\n".join(broken))
