#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the command lines that the documents show.

check_commands.py         every command and option exists in what the programs print for --help
check_commands.py --run   runs the blocks below a line <!-- runs -->, each page in a folder of its own

Environment: FURROW_BIN, the folder with furrow and furrowd.

How a page is run: commands run in order. A furrowd stays up until the next furrowd or the end of the
page; all ports are free ones, and `localhost` becomes the right address. Endless commands get an end,
and pictures are small. Recordings, characters and a take with usual names (take.bvh, hero.glb,
take.mcap) are there. A block of TOML whose first line is a comment with a file name is written to
that file.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.request

import documents

import cli_reference  # from docs/

SKIPPED_PAGES = {"CHANGELOG.md"}  # tells of former versions, too
# The pages must run at least these.
EXPECTED = {"furrowd", "furrow play", "furrow watch", "furrow frames", "furrow solve", "furrow render", "furrow rig"}
INLINE = re.compile(r"`(furrowd?(?: [^`\n]+)?)`")


# ---- Do the options exist? -----------------------------------------------------------------------


def fault_of(words, helps, whole):
    """What is wrong with a command line, or an empty text. `whole`: required options must be there."""
    name, rest = words[0], words[1:]
    while rest and helps[name].subcommands and rest[0] in helps[name].subcommands:
        name, rest = f"{name} {rest[0]}", rest[1:]
    command = helps[name]
    options = {word.split("=")[0] for word in rest if re.match(r"-(-|[a-z]$)", word)}
    if command.subcommands and whole and not options & {"--help", "--version", "-h"}:
        return f"'{rest[0] if rest else ''}' is not a command of {name}"
    if command.subcommands and rest and re.fullmatch(r"[a-z][a-z-]+", rest[0]):
        return f"'{rest[0]}' is not a command of {name}"
    unknown = sorted(options - set(command.flags))
    if unknown:
        return f"{name} has no option {', '.join(unknown)}"
    needed = {entry.name.split()[0] for section, entries in command.sections.items() if section != "Positionals"
              for entry in entries if " REQUIRED" in entry.name}
    missing = sorted(needed - options) if whole and not options & {"--help", "-h", "--print-settings"} else []
    return f"{name} needs {', '.join(missing)}" if missing else ""


def check_page(name, text, helps):
    """Problems of one page."""
    problems = []
    for block in documents.blocks(text):
        if block.language not in documents.SHELLS:
            continue
        if not block.language and not re.search(r"^\s*(\$ )?furrowd?\b", block.text, re.M):
            continue  # a drawing, a formula
        for line in documents.command_lines(block):
            if line.words[0] in ("furrow", "furrowd"):
                if fault := fault_of(line.words, helps, True):
                    problems.append(f"{name}:{line.number}: {fault}")
    prose = re.sub(r"^\s*```.*?^\s*```\s*$", lambda match: "\n" * match[0].count("\n"), text, flags=re.M | re.S)
    for match in INLINE.finditer(prose):
        if fault := fault_of(match[1].split(), helps, False):
            problems.append(f"{name}:{prose.count(chr(10), 0, match.start()) + 1}: {fault}")
    return problems


def check_all():
    helps = cli_reference.all_commands(documents.programs())
    problems = []
    for page in documents.pages():
        name = page.relative_to(documents.ROOT).as_posix()
        if name not in SKIPPED_PAGES and not name.startswith("docs/history/"):
            problems += check_page(name, page.read_text(), helps)
    return documents.report(problems, "commands of the documents")


# ---- Do they run? --------------------------------------------------------------------------------


class PageRun:
    """Runs the marked blocks of one page."""

    def __init__(self, folder):
        self.folder = folder
        self.daemon = None
        self.performer = None
        self.plays = False  # the daemon plays a recording itself
        built = documents.programs().resolve().parent
        self.share = built / "share" / "furrow"
        performance = self.share / "recordings" / "performance.bvh"
        for name, target in {"take.bvh": performance, "performance.bvh": performance,
                             "hero.glb": self.share / "default.glb",
                             "hero.rig.json": self.share / "default.rig.json"}.items():
            (folder / name).symlink_to(target)
        (folder / "build").mkdir()
        (folder / "build" / "release").symlink_to(built)
        documents.furrow("convert", performance, folder / "take.mcap")

    def close(self):
        """Ends what still runs. Returns problems."""
        if self.performer:
            self.performer.__exit__()
        code = self.daemon.stop() if self.daemon else 0
        self.performer = self.daemon = None
        self.plays = False
        return [f"furrowd ended with exit code {code}"] if code else []

    def write_file(self, block):
        """A block of TOML that names its file in its first line. Fixed ports become free ones."""
        if name := re.match(r"# (\S+\.toml)$", block.text.splitlines()[0]):
            text = re.sub(r"^((?:tcp|udp|port|vmc|livelink_face) *= *)\d+", r"\g<1>0", block.text, flags=re.M)
            (self.folder / name[1]).write_text(text + "\n")

    def require_daemon(self, pictures):
        if self.daemon is None:
            self.daemon = documents.Daemon(*([] if pictures else ["--no-render"]), cwd=self.folder)

    def require_subject(self):
        # A subject of an earlier `furrow play` is listed for a while after it ended, so the list alone does not
        # tell whether somebody performs.
        if self.performer is None and not self.plays:
            self.performer = documents.Performer(self.daemon, self.folder / "take.bvh", "stage")

    def run(self, line):
        """Runs one command line to its end, or starts a daemon. Raises on failure."""
        words = line.words
        if words[0] == "furrowd":
            self.close()
            self.daemon = documents.Daemon(*words[1:], cwd=self.folder)
            self.plays = "--play" in words
        elif words[0] == "curl":
            self.require_daemon(False)
            address = words[-1].replace("localhost:7480", self.daemon.address("http"))
            with urllib.request.urlopen(address, timeout=documents.TIMEOUT) as answer:
                answer.read()
        elif words[0] == "furrow":
            output = documents.furrow(*self.bounded(words[1:]), cwd=self.folder)
            if line.output:
                (self.folder / line.output).write_bytes(output)
        else:
            raise RuntimeError(f"cannot run '{words[0]}': leave out the marker <!-- runs -->")

    def bounded(self, words):
        """The words with real addresses, small pictures and an end."""
        command = words[0]
        if "localhost" in words:
            self.require_daemon(command == "frames")
            if command in ("watch", "frames", "record"):
                self.require_subject()
            udp = "--udp" in words or (command == "play" and "--tcp" not in words)
            words = [self.daemon.address("udp" if udp else "tcp") if word == "localhost" else word for word in words]
        if command in ("watch", "frames") and "--frames" not in words:
            words = [*words, "--frames", "2"]
        if command in ("render", "frames") and "--size" not in words:
            words = [*words, "--size", "160x160"]
        if command == "play":
            words = [*words, "--speed", "20"]
        if command == "record":
            words = [word if before != "--duration" else "0.5" for before, word in zip([""] + words, words)]
        return words


def run_page(name, text):
    """Problems of running one page, and the commands that ran."""
    found = documents.blocks(text)
    if not any(block.marker == "runs" for block in found):
        return [], []
    problems, commands = [], []
    with tempfile.TemporaryDirectory() as folder:
        page = PageRun(pathlib.Path(folder))
        try:
            for block in found:
                if block.language == "toml" and block.text:
                    page.write_file(block)
                if block.marker != "runs":
                    continue
                for line in documents.command_lines(block):
                    commands.append(" ".join(line.words[:1 if line.words[0] == "furrowd" else 2]))
                    try:
                        page.run(line)
                    except (RuntimeError, OSError, subprocess.TimeoutExpired) as error:
                        problems.append(f"{name}:{line.number}: {error}")
        finally:
            problems += [f"{name}: {problem}" for problem in page.close()]
    return problems, commands


def run_all():
    problems, commands = [], []
    for page in documents.pages():
        more, ran = run_page(page.relative_to(documents.ROOT).as_posix(), page.read_text())
        problems += more
        commands += ran
    problems += [f"no page runs '{command}'" for command in sorted(EXPECTED - set(commands))]
    return documents.report(problems, f"{len(commands)} commands run")


if __name__ == "__main__":
    os.environ.pop("FURROW_ASSET_PATH", None)
    sys.exit(run_all() if "--run" in sys.argv[1:] else check_all())
