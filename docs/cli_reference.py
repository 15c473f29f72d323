#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the command-line reference from what the programs print for --help.

cli_reference.py BIN OUT: BIN holds furrow and furrowd; OUT receives furrow.md, furrowd.md and
render-settings.md. The tests of the documents import this file to know every command and option.
"""
import html
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass, field

COLUMN = 30  # CLI11 starts descriptions here
TIMEOUT = 60  # seconds; help takes milliseconds


@dataclass
class Entry:
    name: str  # as printed: "--rate FLOAT:FLOAT in [0.001 - 1000]"
    text: str


@dataclass
class Help:
    """The help text of one program or command, taken apart."""
    words: list  # ["furrow", "rig", "check"]
    about: str = ""
    usage: str = ""
    sections: dict = field(default_factory=dict)  # "Options" -> [Entry]
    footer: list = field(default_factory=list)  # lines

    def entries(self, section):
        return self.sections.get(section, [])

    @property
    def subcommands(self):
        return [entry.name.split()[0] for entry in self.entries("Subcommands")]

    @property
    def flags(self):
        """Option names and whether each takes a value: {"--rate": True, "--loop": False}."""
        names = {}
        for section, entries in self.sections.items():
            if section in ("Positionals", "Subcommands"):
                continue
            for entry in entries:
                head, _, rest = entry.name.partition(" ")
                rest = re.sub(r"\b(Excludes|Needs): .*", "", rest).replace("REQUIRED", "").strip()
                for name in head.split(","):
                    names[name] = bool(rest)
        return names


def is_name_only(line, following):
    """Whether an entry's description starts on the next line."""
    return len(line) < COLUMN or line[COLUMN - 1] != " " or (
        line[COLUMN - 2] != " " and following.startswith(" " * COLUMN))


def parse(words, text):
    """Takes apart what CLI11 prints."""
    result = Help(words)
    lines = text.splitlines()
    section, indent, about = None, 2, []  # entries of an option group are indented by 4, others by 2
    for index, line in enumerate(lines):
        following = lines[index + 1] if index + 1 < len(lines) else ""
        heading = re.fullmatch(r"([A-Z]\w+):\s*", line)
        group = re.fullmatch(r"\[Option Group: (.+)\]\s*", line)
        if line.startswith("Usage: "):
            result.about, result.usage = " ".join(about), line[len("Usage: "):]
        elif not result.usage:
            about.append(line)
        elif heading or group:
            section, indent = (group or heading)[1], 4 if group else 2
            result.sections.setdefault(section, [])
        elif line and not line.startswith(" ") or result.footer:
            result.footer.append(line)
        elif section and re.match(rf" {{{indent}}}[-A-Za-z]", line):
            name, description = (line, "") if is_name_only(line, following) else (line[:COLUMN], line[COLUMN:])
            result.sections[section].append(Entry(name.strip(), description.strip()))
        elif section and line.startswith(" " * 20) and result.sections[section]:
            entry = result.sections[section][-1]
            entry.text = f"{entry.text} {line.strip()}".strip()
    return result


def ask(bin_folder, words):
    """Runs `words --help`."""
    command = [str(bin_folder / words[0]), *words[1:], "--help"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=True)
    return parse(words, done.stdout)


def collect(bin_folder, words):
    """The help of a program and of all its commands, parents first."""
    helps = [ask(bin_folder, words)]
    for name in helps[0].subcommands:
        helps += collect(bin_folder, [*words, name])
    return helps


def all_commands(bin_folder):
    """Every command by its words: {"furrow rig check": Help}."""
    return {" ".join(one.words): one
            for program in ("furrow", "furrowd") for one in collect(bin_folder, [program])}


def cell(text):
    return html.escape(text, quote=False).replace("|", "\\|").replace("*", "\\*").replace("_", "\\_").replace("[", "\\[")


def constraint(name):
    """The range, the default and the exclusions that CLI11 prints inside an entry's name."""
    notes = []
    if "REQUIRED" in name:
        notes.append("required")
    if bounds := re.search(r" in \[(\S+) - (\S+)\]", name):
        notes.append(f"range: {bounds[1]} to {bounds[2]}")
    if default := re.search(r"=([^=\s]+)$", name.split(" Excludes:")[0].split(" Needs:")[0]):
        notes.append(f"default: {default[1]}")
    for word, says in (("Excludes", "not with"), ("Needs", "only with")):
        if found := re.search(rf"{word}: ((?:\S+ ?)+?)(?= Excludes:| Needs:|$)", name):
            notes.append(f"{says} {', '.join(found[1].split())}")
    return "; ".join(notes)


def bare(name):
    """The name and its type alone: "--rate FLOAT"."""
    name = re.sub(r" (Excludes|Needs):.*", "", name).replace(" REQUIRED", "")
    name = re.sub(r":?(INT|FLOAT|UINT) in \[.*?\]", "", name)
    name = re.sub(r":(\{[^}]*\}|[A-Z][A-Za-z,]*|POSITIVE|NONNEGATIVE)", "", name)
    return re.sub(r"=\S*$", "", name).strip().replace("-h,--help", "-h, --help")


def table(entries, first):
    """Rows for options or arguments; the column of notes only if some entry has one."""
    notes = [constraint(entry.name) for entry in entries]
    rows = [f"| {first} | Meaning | Notes |", "|---|---|---|"] if any(notes) else [f"| {first} | Meaning |", "|---|---|"]
    for entry, note in zip(entries, notes):
        name = bare(entry.name)
        if first == "Argument":
            name = name.replace(" TEXT", "")
        rows.append(f"| `{name}` | {cell(entry.text)} |" + (f" {cell(note)} |" if any(notes) else ""))
    return rows


def page_part(one, level):
    """One command as Markdown."""
    lines = [f"{'#' * level} {' '.join(one.words)}", "", cell(one.about), "",
             "```text", one.usage, "```", ""]
    for section, entries in one.sections.items():
        if level > 1:
            entries = [entry for entry in entries if not entry.name.startswith("-h,")]
        if section == "Subcommands" or not entries:
            continue
        first = {"Positionals": "Argument"}.get(section, "Option")
        if section not in ("Options", "Positionals"):
            lines += [f"Options of the group *{section}*:", ""]
        lines += [*table(entries, first), ""]
    return lines


def program_page(helps):
    """All commands of one program on a page."""
    top = helps[0]
    lines = page_part(top, 1)
    lines.insert(1, "\n*Generated from `--help` when the site was built.*")
    if len(helps) > 1:
        lines += ["| Command | Purpose |", "|---|---|"]
        for one in helps[1:]:
            anchor = "-".join(one.words)
            lines.append(f"| [`{' '.join(one.words)}`](#{anchor}) | {cell(one.about)} |")
        lines.append("")
    if top.footer:
        lines += ["```text", *top.footer, "```", ""]
    for one in helps[1:]:
        lines += page_part(one, 2)
    return "\n".join(lines).rstrip() + "\n"


def settings_page(bin_folder):
    """Every setting of the renderer, as `furrow render --print-settings` writes it."""
    done = subprocess.run([str(bin_folder / "furrow"), "render", "--print-settings"],
                          capture_output=True, text=True, timeout=TIMEOUT, check=True)
    return ("# Render settings\n\n*Generated by `furrow render --print-settings` when the site was built.*\n\n"
            "This is a valid settings file. It holds every setting of the renderer with its meaning, range, unit and\n"
            "default. [Rendering](../RENDERING.md) explains the important ones.\n\n```toml\n"
            + done.stdout.rstrip() + "\n```\n")


def write(bin_folder, out):
    out.mkdir(parents=True, exist_ok=True)
    for program in ("furrow", "furrowd"):
        (out / f"{program}.md").write_text(program_page(collect(bin_folder, [program])))
    (out / "render-settings.md").write_text(settings_page(bin_folder))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: cli_reference.py BIN OUT")
    write(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
