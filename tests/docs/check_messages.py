#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that docs/troubleshooting.md quotes messages that the programs really print.

Every line of a ```text block there is a message. <Words in angle brackets> stand for what varies; each
other part of at least MIN_PART characters must occur in a string of the sources.
"""
import re
import sys

import documents

PAGE = documents.ROOT / "docs" / "troubleshooting.md"
FOLDERS = ("server", "client", "render", "rig", "character", "motion", "recording", "protocol", "base", "gltf")
MIN_PART = 8


def strings_of_sources(root):
    """All string literals of the sources; adjacent literals are joined, placeholders become a mark."""
    found = []
    for folder in FOLDERS:
        for path in documents.files({".cpp", ".h"}, root / folder):
            text = re.sub(r'"\s*\n\s*"', "", path.read_text())
            found += re.findall(r'"((?:\\.|[^"\\\n])*)"', text)
    return "\n".join(re.sub(r"\{\}|%s", "\0", text) for text in found)


def parts(message):
    """The fixed parts of a message."""
    return [part.strip(" '") for part in re.split(r"<[^>]*>", message) if len(part.strip(" '")) >= MIN_PART]


def main():
    sources = strings_of_sources(documents.ROOT)
    problems = []
    for block in documents.blocks(PAGE.read_text()):
        if block.language != "text":
            continue
        for offset, message in enumerate(block.text.splitlines()):
            for part in parts(message):
                if part not in sources:
                    problems.append(f"docs/troubleshooting.md:{block.line + offset}: no program prints '{part}'")
    return documents.report(problems, "quoted messages")


if __name__ == "__main__":
    sys.exit(main())
