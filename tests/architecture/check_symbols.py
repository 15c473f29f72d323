#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what libfurrow.so offers to programs, and what it needs from the system.

    check_symbols.py LIBRARY HEADER LIST [--update]

LIST holds the exported symbols with their versions, as committed. The library must export exactly these, and the
header must declare exactly these. A symbol that disappears breaks programs; a symbol that appears by accident can
never be removed again. --update writes LIST, for a change that is meant.
"""
import pathlib
import re
import subprocess
import sys

# The C++ runtime and the C library. Sanitizers add their own.
NEEDED = re.compile(r"lib(stdc\+\+|m|gcc_s|c|sodium|ssl|crypto|asan|ubsan|tsan|gcov)\.so\.\d+|ld-linux.*\.so\.\d+")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def exported(library):
    """The defined dynamic symbols, as "name@@VERSION"; the symbol of each version itself is absolute (A)."""
    symbols = [line.split() for line in run("nm", "-D", "--defined-only", library).splitlines()]
    return sorted(symbol[-1] for symbol in symbols if symbol[-2] != "A")


def declared(header):
    text = re.sub(r"/\*.*?\*/|^#.*?$", "", pathlib.Path(header).read_text(), flags=re.S | re.M)
    return sorted(re.findall(r"FURROW_API[^;(]*?(\w+)\(", text))


def needed(library):
    return re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "-d", library))


def main(library, header, listing, *options):
    symbols = exported(library)
    path = pathlib.Path(listing)
    if "--update" in options:
        path.write_text("\n".join(symbols) + "\n")
    committed = path.read_text().split()
    names = [symbol.partition("@@")[0] for symbol in symbols]
    faults = [f"the library lost {symbol}" for symbol in committed if symbol not in symbols]
    faults += [f"the library exports {symbol}, which {path.name} does not list" for symbol in symbols
               if symbol not in committed]
    faults += [f"the header declares {name}, which the library does not export" for name in declared(header)
               if name not in names]
    faults += [f"the library exports {name}, which the header does not declare" for name in names
               if name not in declared(header)]
    faults += [f"the library needs {name}" for name in needed(library) if not NEEDED.fullmatch(name)]
    if not names:
        faults.append("no symbols were found")
    for fault in faults:
        print(fault)
    print(f"check_symbols: {len(symbols)} symbols, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
