#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes man pages and completions for bash, zsh and fish from what the programs print for --help.

manuals.py BIN SHARE: BIN holds furrow and furrowd; SHARE receives the folders man, bash-completion, zsh and fish, in which
the system's programs look for them.
"""
import pathlib
import subprocess
import sys

import bash_completion
import cli_reference
import fish_completion
import man_pages
import zsh_completion


def version(bin_folder):
    """The release, from `furrow --version`."""
    command = [str(bin_folder / "furrow"), "--version"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=cli_reference.TIMEOUT, check=True)
    return done.stdout.split()[-1]


def write(bin_folder, share):
    programs = [cli_reference.collect(bin_folder, [program]) for program in ("furrow", "furrowd")]
    man_pages.write(programs, version(bin_folder), share / "man" / "man1")
    bash_completion.write(programs, share / "bash-completion" / "completions")
    zsh_completion.write(programs, share / "zsh" / "site-functions")
    fish_completion.write(programs, share / "fish" / "vendor_completions.d")
    return programs


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: manuals.py BIN SHARE")
    write(*map(pathlib.Path, sys.argv[1:]))
