#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks links, anchors and pictures.

check_links.py [ROOT]         every Markdown page of the tree, as a forge shows them
check_links.py --site FOLDER  every page of the built site; it must load nothing from other hosts
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

import documents

LINK = re.compile(r"`[^`\n]+`|!?\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(([^)\s]+)\)")


def anchors_of(text):
    """The anchors that a forge makes of the headings of a page."""
    found = set()
    text = re.sub(r"^\s*```.*?^\s*```\s*$", "", text, flags=re.M | re.S)
    for title in re.findall(r"^#+ +(.*)$", text, re.M):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        slug = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
        found.add(slug)
    return found


def check_tree(root):
    """Problems of the Markdown pages below `root`."""
    problems = []
    for page in documents.pages(root):
        text = page.read_text()
        # Blank the fenced blocks, and keep the numbers of the lines.
        prose = re.sub(r"^\s*```.*?^\s*```\s*$", lambda match: "\n" * match[0].count("\n"), text, flags=re.M | re.S)
        for match in LINK.finditer(prose):
            target = match[1]
            if target is None or re.match(r"[a-z]+:", target):
                continue
            where = f"{page.relative_to(root)}:{prose.count(chr(10), 0, match.start()) + 1}"
            path, _, anchor = target.partition("#")
            wanted = (page.parent / urllib.parse.unquote(path)).resolve() if path else page
            if is_generated(wanted, root):
                continue
            if not wanted.exists():
                problems.append(f"{where}: link to a missing file: {target}")
            elif anchor and wanted.suffix == ".md" and anchor not in anchors_of(wanted.read_text()):
                problems.append(f"{where}: link to a missing heading: {target}")
    return problems


def is_generated(path, root):
    """Pages that docs/cli_reference.py writes; the check of the built site sees them."""
    return path in {root / "docs" / "reference" / name for name in ("furrow.md", "furrowd.md", "render-settings.md")}


class Page(html.parser.HTMLParser):
    """The links, loads and anchors of an HTML page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.update(value for key, value in attrs.items() if key in ("id", "name") and value)
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        if tag in ("img", "script", "iframe", "source") and attrs.get("src"):
            self.loads.append(attrs["src"])
        if tag == "link" and attrs.get("href") and attrs.get("rel") not in ("canonical", "next", "prev"):
            self.loads.append(attrs["href"])


def check_site(folder):
    """Problems of the built site."""
    problems = []
    known = {path: Page(path.read_text()) for path in sorted(folder.rglob("*.html"))}
    for path, page in known.items():
        where = path.relative_to(folder)
        for target in page.loads:
            if re.match(r"(https?:)?//", target):
                problems.append(f"{where}: loads from another host: {target}")
        for target in page.links + page.loads:
            if re.match(r"[a-z]+:|//", target) or path.name == "404.html":
                continue
            name, _, anchor = target.partition("#")
            wanted = (path.parent / urllib.parse.unquote(name.split("?")[0])).resolve() if name else path
            wanted = wanted / "index.html" if wanted.is_dir() else wanted
            if not wanted.exists():
                problems.append(f"{where}: link to a missing page: {target}")
            elif anchor and wanted in known and urllib.parse.unquote(anchor) not in known[wanted].anchors:
                problems.append(f"{where}: link to a missing anchor: {target}")
    if not known:
        problems.append(f"{folder}: no pages")
    return problems


def main(args):
    if args[:1] == ["--site"]:
        folder = pathlib.Path(args[1]).resolve()
        if not (folder / "index.html").exists():
            print("SKIPPED: the site was not built (see the test docs.site)")
            return 77
        return documents.report(check_site(folder), "links of the site")
    root = pathlib.Path(args[0]).resolve() if args else documents.ROOT
    return documents.report(check_tree(root), "links of the tree")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
