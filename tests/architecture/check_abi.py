#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the interface of furrow.h with the one that is committed, by abidiff of Debian's abigail-tools.

    check_abi.py INCLUDE BASELINE [--update]

A parameter, a field or a number of an enumeration that changes breaks programs that were compiled before, although the
names of all symbols stay (check_symbols.py). --update writes BASELINE, for a change that is meant. Exit code 77: abidiff is
missing. Environment: CC, the compiler.

abidiff reads debug information. That of the library would list half of the C++ standard library, too. So the script compiles
the declarations of the header with empty bodies; the library itself is compiled against the same declarations.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77


def run(*command):
    return subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)


def compile_interface(include, folder):
    """A library with the functions of furrow.h, which do nothing."""
    text = pathlib.Path(include, "furrow", "furrow.h").read_text()
    text = re.sub(r"(FURROW_API void [^;{]+);", r"\1 {}", text)
    text = re.sub(r"(FURROW_API [^;{]+);", r"\1 { return 0; }", text)
    source, library = pathlib.Path(folder, "furrow.h"), pathlib.Path(folder, "libfurrow.so.1")
    source.write_text(text.replace("#pragma once", ""))
    done = run(os.environ.get("CC", "cc"), "-std=c99", "-g", "-O0", "-fPIC", "-shared", "-w", "-x", "c", source, "-o", library)
    if done.returncode:
        sys.exit(f"check_abi: cannot compile the interface:\n{done.stderr}")
    return library


def difference(baseline, library):
    """What abidiff prints; empty if nothing differs."""
    done = run("abidiff", baseline, library)
    return done.stdout + done.stderr if done.returncode else ""


def planted_fault_is_found(baseline, library):
    """A baseline with one parameter more must differ, or this check sees nothing."""
    with tempfile.TemporaryDirectory() as folder:
        planted = pathlib.Path(folder, "planted.abi")
        text = baseline.read_text()
        at = text.index("<parameter", text.index("<function-decl name='furrow_poll'"))
        planted.write_text(text[:at] + text[at:text.index("/>", at) + 2] + text[at:])
        return bool(difference(planted, library))


def main(include, listing, *options):
    baseline = pathlib.Path(listing)
    if not shutil.which("abidiff"):
        print("SKIPPED: abidiff is missing (deploy/install-deps.sh all)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        library = compile_interface(include, folder)
        if "--update" in options:
            baseline.write_text(run("abidw", "--no-corpus-path", "--no-comp-dir-path", "--no-show-locs", "--no-elf-needed",
                                    library).stdout.replace(folder, ""))
        if found := difference(baseline, library):
            print(found)
            print(f"check_abi: the interface differs from {baseline.name}; if that is meant, run this again with --update")
            return 1
        if not planted_fault_is_found(baseline, library):
            print("check_abi: abidiff does not find a planted fault")
            return 1
    print("check_abi: no difference")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
