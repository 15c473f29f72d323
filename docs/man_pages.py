# SPDX-License-Identifier: Apache-2.0
"""Man pages from what the programs print for --help: furrow.1, furrowd.1 and a page per command, such as
furrow-rig-check.1. They say what --help says, because cli_reference.py reads it for both.
"""
import re

import cli_reference

# Pages that every page of a program refers to.
ALSO = {"furrow": ["furrowd"], "furrowd": ["furrow"]}


def plain(text):
    """Text for troff: no character of it is a command."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def entry_lines(entry):
    """An option or argument with its meaning."""
    note = cli_reference.constraint(entry.name)
    text = entry.text + (f" ({note})" if note else "")
    return [".TP", f"\\fB{plain(cli_reference.bare(entry.name))}\\fR", plain(text) or "\\&"]


def section_lines(one):
    """The options, arguments and commands of a page."""
    lines = []
    names = {"Positionals": "ARGUMENTS", "Options": "OPTIONS", "Subcommands": "COMMANDS"}
    for section, entries in one.sections.items():
        if section == "Subcommands":
            entries = [cli_reference.Entry(entry.name.split()[0], entry.text) for entry in entries]
        if entries:
            lines.append(f'.SH "{plain(names.get(section, "OPTIONS: " + section).upper())}"')
        for entry in entries:
            lines += entry_lines(entry)
    return lines


def page(one, footer, release):
    """One page. `footer`: of the program, with its exit codes."""
    name = "-".join(one.words)
    usage = one.usage.split("/")[-1] if one.usage.startswith("/") else one.usage
    lines = [f'.TH "{plain(name).upper()}" 1 "" "Furrow {plain(release)}" "Furrow"',
             ".SH NAME", f"{plain(name)} \\- {plain(one.about or name)}",
             ".SH SYNOPSIS", plain(usage), *section_lines(one)]
    if footer:
        lines += [".SH NOTES", ".nf", *(plain(line) or "\\&" for line in footer), ".fi"]
    others = [f"{'-'.join([*one.words, command])}" for command in one.subcommands]
    parent = ["-".join(one.words[:-1])] if len(one.words) > 1 else ALSO[one.words[0]]
    lines += [".SH SEE ALSO", ", ".join(f"\\fB{plain(other)}\\fR(1)" for other in parent + others)]
    return "\n".join(lines) + "\n"


def write(programs, release, out):
    """Writes the pages of some programs. `programs`: per program, the help of it and of all its commands."""
    out.mkdir(parents=True, exist_ok=True)
    for old in out.glob("*.1"):
        old.unlink()  # a command that is gone leaves no page
    for helps in programs:
        for one in helps:
            (out / f"{'-'.join(one.words)}.1").write_text(page(one, helps[0].footer, release))
