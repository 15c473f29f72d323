#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes man pages and bash completions from what the programs print for --help.

manuals.py BIN MAN COMPLETIONS: BIN holds furrow and furrowd; MAN receives the pages, and COMPLETIONS a file per program.
"""
import pathlib
import subprocess
import sys

import bash_completion
import cli_reference
import man_pages


def version(bin_folder):
    """The release, from `furrow --version`."""
    command = [str(bin_folder / "furrow"), "--version"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=cli_reference.TIMEOUT, check=True)
    return done.stdout.split()[-1]


def write(bin_folder, man, completions):
    programs = [cli_reference.collect(bin_folder, [program]) for program in ("furrow", "furrowd")]
    man_pages.write(programs, version(bin_folder), man)
    bash_completion.write(programs, completions)
    return programs


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: manuals.py BIN MAN COMPLETIONS")
    write(*map(pathlib.Path, sys.argv[1:]))
