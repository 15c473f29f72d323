#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the documentation site with MkDocs.

build_site.py --source DIR --bin DIR --generated DIR --out DIR

The site has three kinds of pages: those of docs/, those that live beside the code they describe
(protocol/STANDARD.md and others, see OUTSIDE), and generated ones (cli_reference.py). This script
collects all of them in OUT-source, points the links between them at their new places, and runs
`mkdocs build --strict` on that folder. Exit code 77: MkDocs or its theme is not installed.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

import cli_reference

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
COPIED = {".md", ".svg", ".jpg", ".png", ".css", ".json"}

# Pages outside docs/, and where they go in the site.
OUTSIDE = {
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "README.md": "index.md",  # links only: the site has its own front page
    "protocol/STANDARD.md": "reference/wire.md",
    "shaders/README.md": "reference/shaders.md",
}
LINKS_ONLY = {"README.md"}

# A link or picture; or, unmatched by groups, a code span, in which nothing is a link.
LINK = re.compile(r"`[^`\n]+`|(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s]+)\)")
INCLUDE = re.compile(r"<!-- include: (\S+) (\w+) -->")


class Site:
    """Source pages by their place in the repository, and where each goes."""

    def __init__(self, source, generated):
        self.source = source
        self.generated = generated
        self.places = {}  # "docs/RIG.md" -> "RIG.md"
        for path in sorted((source / "docs").rglob("*")):
            if path.suffix in COPIED and path.is_file():
                inside = path.relative_to(source / "docs").as_posix()
                self.places[f"docs/{inside}"] = inside
        self.places.update(OUTSIDE)

    def rewrite(self, text, origin):
        """The text of a page at `origin` (from the root) with links that hold inside the site."""
        parts = re.split(r"(^```.*?^```[ ]*$)", text, flags=re.M | re.S)
        for index in range(0, len(parts), 2):
            parts[index] = LINK.sub(lambda match: self.link(match, origin), parts[index])
        return INCLUDE.sub(self.include, "".join(parts))

    def link(self, match, origin):
        picture, label, target = match.groups()
        if target is None or re.match(r"[a-z]+:|#|/", target):
            return match[0]
        path, _, anchor = target.partition("#")
        wanted = os.path.normpath(os.path.join(os.path.dirname(origin), path))
        if wanted in self.places:
            here = os.path.dirname(self.places[origin])
            there = os.path.relpath(self.places[wanted], here or ".")
            return f"{picture}[{label}]({there}{'#' + anchor if anchor else ''})"
        if not picture and (self.source / wanted).exists():
            # A source file, which the site does not hold: its name, which most labels are already.
            return label if wanted in label.replace("\\", "") else f"{label} (`{wanted}`)"
        return match[0]  # generated, or wrong: MkDocs decides

    def include(self, match):
        """A file of the tree, or of the generated files ("generated/..."), as a fenced block."""
        folder, _, rest = match[1].partition("/")
        path = self.generated / rest if folder == "generated" else self.source / match[1]
        return f"```{match[2]}\n{path.read_text().rstrip()}\n```"

    def stage(self, folder, bin_folder):
        """Collects all pages in `folder`, and deletes what was there."""
        if folder.exists():
            shutil.rmtree(folder)
        for origin, place in self.places.items():
            if origin in LINKS_ONLY:
                continue
            target = folder / place
            target.parent.mkdir(parents=True, exist_ok=True)
            if origin.endswith(".md"):
                target.write_text(self.rewrite((self.source / origin).read_text(), origin))
            else:
                shutil.copyfile(self.source / origin, target)
        cli_reference.write(bin_folder, folder / "reference")


def find_mkdocs():
    """The command, or None with the reason printed."""
    command = shutil.which("mkdocs")
    if command is None:
        print("SKIPPED: mkdocs is not installed (Debian packages: mkdocs, mkdocs-material)")
        return None
    themes = subprocess.run([command, "build", "--help"], capture_output=True, text=True, check=True).stdout
    if "material" not in themes:
        print("SKIPPED: the Material theme of mkdocs is not installed (Debian package: mkdocs-material)")
        return None
    return command


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--source", type=pathlib.Path, required=True, help="root of the repository")
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder with furrow and furrowd")
    parser.add_argument("--generated", type=pathlib.Path, required=True,
                        help="folder of the files that the build generates")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the built site")
    args = parser.parse_args()
    mkdocs = find_mkdocs()
    if mkdocs is None:
        return SKIPPED
    staged = args.out.resolve().with_name(args.out.name + "-source")
    Site(args.source.resolve(), args.generated.resolve()).stage(staged, args.bin.resolve())
    return subprocess.run(
        [mkdocs, "build", "--strict", "--config-file", str(args.source / "mkdocs.yml"),
         "--site-dir", str(args.out.resolve())],
        env={**os.environ, "FURROW_DOCS_SOURCE": str(staged)}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
