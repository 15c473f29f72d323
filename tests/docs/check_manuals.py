#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the generated man pages and completions of bash, zsh and fish (docs/manuals.py). Shells that are missing are
left out.

Environment: FURROW_BIN, the folder with furrow and furrowd.
"""
import os
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
    ("furrow token key ", {"new", "list", "retire"}),
    ("furrow token new --role w", {"watch"}),
    ("furrow play ", set()),
    ("furrowd --no-r", {"--no-render"}),
    ("furrowd ", set()),
]


def answer(shell, *command):
    """The words that a shell prints."""
    done = subprocess.run([shell, *command], capture_output=True, text=True, timeout=documents.TIMEOUT, check=False)
    if done.returncode or done.stderr:
        return {f"{shell} failed: {done.stderr}"}
    return set(done.stdout.split())


def bash_offers(share, line):
    script = share / "bash-completion" / "completions" / line.split()[0]
    words = line.split(" ")
    program = f"source '{script}'; COMP_WORDS=({' '.join(repr(word) for word in words)}); " \
              f"COMP_CWORD={len(words) - 1}; _{words[0]}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return answer("bash", "-uc", program)


def zsh_offers(share, line):
    """Stand-ins for zsh's own functions print what they receive. zsh itself drops what does not begin so."""
    script = share / "zsh" / "site-functions" / f"_{line.split()[0]}"
    words = line.split(" ")
    program = f"""
        compadd() {{ print -l -- ${{@[2,-1]}} }}
        _describe() {{ print -l -- ${{${{(P)2}}%%:*}} }}
        _files() {{ }}
        words=({' '.join(repr(word) for word in words)}); CURRENT={len(words)}; source '{script}'"""
    return {word for word in answer("zsh", "-fc", program) if word.startswith(words[-1]) or " " in word}


def fish_offers(share, line):
    """Words with their descriptions. Files are left out: fish offers those of the present folder."""
    script = share / "fish" / "vendor_completions.d" / f"{line.split()[0]}.fish"
    done = subprocess.run(["fish", "--no-config", "-c", f"source '{script}'; complete -C '{line}'"], cwd=script.parent,
                          capture_output=True, text=True, timeout=documents.TIMEOUT, check=False,
                          env={**os.environ, "HOME": str(share)})
    if done.returncode or done.stderr:
        return {f"fish failed: {done.stderr}"}
    words = {offer.split("\t")[0] for offer in done.stdout.splitlines()}
    return {word for word in words if not (script.parent / word).exists()}


def check_completions(share):
    for shell, offers in (("bash", bash_offers), ("zsh", zsh_offers), ("fish", fish_offers)):
        for line, wanted in COMPLETIONS if shutil.which(shell) else ():
            offered = offers(share, line)
            if not wanted <= offered or (not wanted and offered):
                yield f"{shell}, completion of '{line}': offered {sorted(offered)}, expected {sorted(wanted)}"
            prefix = line.split(" ")[-1]
            if strange := [word for word in offered if not word.startswith(prefix)]:
                yield f"{shell}, completion of '{line}': {strange} do not begin so"


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
        programs = manuals.write(documents.programs(), folder)
        problems = [*check_man_pages(folder / "man" / "man1", programs), *check_completions(folder)]
    return documents.report(problems, "man pages and completions")


if __name__ == "__main__":
    sys.exit(main())
