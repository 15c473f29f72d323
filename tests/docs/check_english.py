#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds lines of prose that are usually hard to read (CONTRIBUTING.md, "English").

check_english.py          fails on a line that matches and is not in english_allowed.txt
check_english.py --list   prints all matching lines in the format of that file

english_allowed.txt holds lines that were read and are good English as they are: `path: line`, the line
without its indentation. An entry that matches nothing any more is a failure, too.
"""
import pathlib
import re
import sys

import documents

CODE = {".cpp", ".h", ".ts", ".mjs", ".js", ".glsl", ".fbs", ".c"}
SCRIPTS = {".py", ".sh", ".cmake", ".toml", ".yml", ".yaml"}
ALLOWED = pathlib.Path(__file__).with_name("english_allowed.txt")
# These files quote the patterns.
EXEMPT = {"tests/docs/check_english.py", "tests/docs/english_allowed.txt", "tests/docs/test_checks.py"}

OPENING = re.compile(r"(?:^|(?:^|\s)(?://+|#|\*|\d\.|-) +)"
                     r"(?:Who|Whoever|Whose|What is|What was|What comes|That which|Of who|Of what|Such a) ")
ANYWHERE = re.compile(r"befall|cannot be had|\bstands in\b|\bstand beside\b|\b(?:is|are) told\b|by the thread of|"
                      r"\bof whom\b|\bthereof\b|\bit is due\b|as long as it stays|\bso many\b|\banew\b|falls silent|"
                      r"(?<!there )\b(?:is|are) no (?!longer)|has been there longest", re.I)


def is_question(line):
    """Questions may begin with Who and What."""
    return bool(re.search(r"\?\W*$", line))


def prose_lines(path):
    """The lines of a file that hold prose: (number, text)."""
    text = path.read_text(errors="replace")
    if path.suffix == ".md":
        text = re.sub(r"^\s*```.*?^\s*```\s*$", lambda match: "\n" * match[0].count("\n"), text, flags=re.M | re.S)
        return list(enumerate(text.splitlines(), 1))
    mark = r"//|\"" if path.suffix in CODE else r"#|\""
    return [(number, line) for number, line in enumerate(text.splitlines(), 1) if re.search(mark, line)]


def matches(line):
    return bool(ANYWHERE.search(line) or (OPENING.search(line.strip()) and not is_question(line)))


def find(root):
    """All matching lines: (path, number, text)."""
    for path in documents.files(CODE | SCRIPTS | {".md"}, root):
        name = path.relative_to(root).as_posix()
        if name in EXEMPT or name.startswith(("third_party/", "docs/history/")) or path.name == "CMakeLists.txt":
            continue
        for number, line in prose_lines(path):
            if matches(line):
                yield name, number, line.strip()


def allowed_entries():
    """The judged lines, as (path, text)."""
    entries = set()
    for line in ALLOWED.read_text().splitlines():
        if line and not line.startswith("#"):
            name, _, text = line.partition(": ")
            entries.add((name, text))
    return entries


def main(args):
    found = list(find(documents.ROOT))
    if "--list" in args:
        for name, _, text in found:
            print(f"{name}: {text}")
        return 0
    allowed = allowed_entries()
    problems = [f"{name}:{number}: {text}" for name, number, text in found if (name, text) not in allowed]
    stale = allowed - {(name, text) for name, _, text in found}
    problems += [f"tests/docs/english_allowed.txt: matches nothing any more: {name}: {text}" for name, text in sorted(stale)]
    return documents.report(problems, "English")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
