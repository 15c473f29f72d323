#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the generated man pages and bash completions (docs/manuals.py).

Environment: FURROW_BIN, the folder with furrow and furrowd.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import documents

import manuals  # from docs/

# A line as typed so far, and words of which all must be offered, or none at all ("" stands for no offer).
COMPLETIONS = [
    ("furrow pl", {"play"}),
    ("furrow ", {"play", "watch", "rig", "bake"}),
    ("furrow rig ", {"check", "explain"}),
    ("furrow watch --fo", {"--format"}),
    ("furrow watch --format ", {"csv", "jsonl", "table"}),
    ("furrow watch --format j", {"jsonl"}),
    ("furrow watch host --subject ", set()),
    ("furrow rig check --", {"--help"}),
    ("furrow play ", set()),
    ("furrowd --no-r", {"--no-render"}),
    ("furrowd ", set()),
]


def completions(script, line):
    """What bash offers for a line."""
    words = line.split(" ")
    program = f"source '{script}'; COMP_WORDS=({' '.join(repr(word) for word in words)}); " \
              f"COMP_CWORD={len(words) - 1}; _{words[0]}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    done = subprocess.run(["bash", "-uc", program], capture_output=True, text=True, timeout=documents.TIMEOUT,
                          check=False)
    if done.returncode:
        return {f"bash failed: {done.stderr}"}
    return set(done.stdout.split())


def check_completions(folder):
    for line, wanted in COMPLETIONS:
        offered = completions(folder / line.split()[0], line)
        if not wanted <= offered or (not wanted and offered):
            yield f"completion of '{line}': offered {sorted(offered)}, expected {sorted(wanted)}"
        prefix = line.split(" ")[-1]
        if strange := [word for word in offered if not word.startswith(prefix)]:
            yield f"completion of '{line}': {strange} do not begin so"


def check_page(path, one):
    """A page must state every option, and troff must accept it."""
    text = path.read_text().replace("\\-", "-")
    for flag in one.flags:
        if flag not in text:
            yield f"{path.name}: the option {flag} is missing"
    if shutil.which("groff"):
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", str(path)], capture_output=True, text=True,
                              timeout=documents.TIMEOUT, check=False)
        if done.returncode or done.stderr:
            yield f"{path.name}: groff: {done.stderr.strip()}"


def check_man_pages(folder, programs):
    helps = {"-".join(one.words): one for program in programs for one in program}
    if missing := sorted(helps.keys() - {path.stem for path in folder.glob("*.1")}):
        yield f"no man page for {', '.join(missing)}"
    for path in sorted(folder.glob("*.1")):
        yield from check_page(path, helps[path.stem])


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        programs = manuals.write(documents.programs(), folder / "man", folder / "bash")
        problems = [*check_man_pages(folder / "man", programs), *check_completions(folder / "bash")]
    return documents.report(problems, "man pages and completions")


if __name__ == "__main__":
    sys.exit(main())
