# SPDX-License-Identifier: Apache-2.0
"""What the checks of the documents share: pages, fenced blocks, command lines, and a daemon to run against."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))
IGNORED = {".git", "build", "node_modules", "demo-out", "bench-out", "__pycache__"}
TIMEOUT = 300  # seconds; only a failure takes that long
SHELLS = {"", "sh", "bash", "console"}


def files(suffixes, root=ROOT):
    """All files of the tree with one of the suffixes, without build folders."""
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(name for name in folders if name not in IGNORED)
        for name in sorted(names):
            if pathlib.Path(name).suffix in suffixes:
                yield pathlib.Path(folder, name)


def pages(root=ROOT):
    """Every Markdown page of the tree."""
    return list(files({".md"}, root))


@dataclass
class Block:
    """A fenced block of a page."""
    language: str
    text: str
    line: int  # of the first line of its text, from 1
    marker: str = ""  # the HTML comment on the line before the fence, without "<!--" and "-->"


def blocks(text):
    """The fenced blocks of a page, in order."""
    found, lines, index = [], text.splitlines(), 0
    while index < len(lines):
        fence = re.fullmatch(r"\s*```(\w*)\s*", lines[index])
        index += 1
        if not fence:
            continue
        start = index
        while index < len(lines) and not re.fullmatch(r"\s*```\s*", lines[index]):
            index += 1
        before = lines[start - 2].strip() if start >= 2 else ""
        comment = re.fullmatch(r"<!-- (.*?) -->", before)
        found.append(Block(fence[1], "\n".join(lines[start:index]), start + 1, comment[1] if comment else ""))
        index += 1
    return found


@dataclass
class Line:
    """One command line of a block: words up to a pipe or redirection."""
    words: list
    number: int
    output: str = ""  # the file behind ">"


def command_lines(block):
    """The lines of a shell block, joined where they end in a backslash, comments and prompts removed."""
    text, number = "", block.line
    for offset, line in enumerate(block.text.splitlines()):
        if not text:
            number = block.line + offset
        text += line
        if text.endswith("\\"):
            text = text[:-1] + " "
            continue
        command = re.sub(r"(^|\s)#.*$", "", re.sub(r"^\s*\$ ", "", text)).strip()
        text = ""
        if not command:
            continue
        reader = shlex.shlex(command, posix=True, punctuation_chars="|&;<>")
        reader.whitespace_split, reader.commenters = True, ""
        words = list(reader)
        end = next((i for i, word in enumerate(words) if set(word) <= set("|&;<>")), len(words))
        output = words[end + 1] if words[end:end + 1] == [">"] else ""
        if end:
            yield Line([pathlib.Path(words[0]).name, *words[1:end]], number, output)


def programs():
    """The folder with furrow and furrowd, from the environment of the test."""
    return pathlib.Path(os.environ["FURROW_BIN"])


class Daemon:
    """A furrowd on free ports. Waits for its ready line; `with` stops it."""

    def __init__(self, *args, cwd=None, env=None):
        words = []
        rest = iter([str(arg) for arg in args])
        for word in rest:
            words.append(word)
            if word in ("--tcp", "--udp", "--http", "--vmc", "--livelink-face"):
                next(rest)
                words.append("0")
        for option in ("--tcp", "--udp", "--http"):
            if option not in words and not (option == "--http" and "--no-http" in words):
                words += [option, "0"]
        self.log = []
        self.process = subprocess.Popen([programs() / "furrowd", *words], cwd=cwd, text=True, env=env,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        line = self.process.stdout.readline()
        if not line.startswith("furrowd ready"):
            self.process.wait(TIMEOUT)
            raise RuntimeError(f"furrowd {' '.join(words)}: exit code {self.process.returncode}")
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=\S*?:(\d+)\b", line)}

    def address(self, kind):
        return f"localhost:{self.ports[kind]}"

    def stop(self):
        """Ends the daemon. It must exit with 0."""
        if self.process.poll() is None:
            self.process.terminate()
        self.process.stdout.close()
        return self.process.wait(TIMEOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def furrow(*args, cwd=None, env=None):
    """Runs `furrow` to its end and returns its output."""
    done = subprocess.run([programs() / "furrow", *map(str, args)], cwd=cwd, env=env, timeout=TIMEOUT,
                          capture_output=True, check=False)
    if done.returncode:
        raise RuntimeError(f"furrow {' '.join(map(str, args))}: exit code {done.returncode}: {done.stderr.decode()}")
    return done.stdout


class Performer:
    """A subject that streams to a daemon until `with` ends."""

    def __init__(self, daemon, recording, subject):
        self.process = subprocess.Popen(
            [programs() / "furrow", "play", recording, "--to", daemon.address("udp"), "--loop", "--subject", subject],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        furrow("watch", daemon.address("tcp"), "--subject", subject, "--wait", "--frames", "1")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(TIMEOUT)


def report(problems, what):
    """Prints problems; the exit code of a check."""
    for problem in problems:
        print(problem)
    print(f"{what}: {len(problems)} problems" if problems else f"{what}: good")
    return 1 if problems else 0
