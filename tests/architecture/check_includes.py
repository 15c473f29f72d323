#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fails on an include that points against the direction of docs/ARCHITECTURE.md.

Two kinds of rule: which of our folders may include which, and which foreign headers stay in which
folder (GL in render/, FlatBuffers in protocol/ and the rig reader, Asio in the two transports).
"""
import pathlib
import re
import sys
import tempfile

# folder -> the folders of ours it may include, besides itself. The longest matching prefix decides.
ALLOWED = {
    "wrinkle": set(),
    "protocol": set(),
    "report": set(),
    "motion": {"wrinkle"},
    "recording": {"wrinkle", "protocol", "motion"},
    "character": {"wrinkle"},
    "render": {"wrinkle", "character"},
    "server": {"wrinkle", "protocol", "motion", "recording", "character", "render"},
    "client/cpp": {"base", "protocol"},
    "client/c": {"protocol", "client/cpp"},
    "client/net": {"base", "protocol", "client/cpp"},
    "client/chaos": {"base", "protocol", "report", "client/cpp", "client/net"},
    "client/load": {"base", "wrinkle", "protocol", "report", "client/cpp", "client/net"},
    "client/cli": {"wrinkle", "protocol", "report", "motion", "recording", "character", "render", "client/cpp",
                   "client/net", "client/chaos", "client/load"},
}

# foreign header -> where it may be included.
CONFINED = [
    (r"(epoxy|GL|EGL|GLES\d)/", {"render"}),
    (r"flatbuffers/|.*_generated\.h$", {"protocol", "character"}),
    (r"asio(\.hpp|/)", {"server", "client/cpp"}),
    (r"boost/", {"server/http"}),
    (r"prometheus/", {"server/http"}),
    (r"glm/", {"wrinkle", "motion", "recording", "character", "render", "server", "client/load", "client/cli"}),
    (r"hwy/", {"wrinkle", "render"}),
    (r"OpenImageIO/", {"character/oiio"}),
    (r"turbojpeg\.h", {"render"}),
    (r"spdlog/", {"server"}),
    (r"CLI/", {"server", "client/cli", "authoring/generator"}),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def folder_of(path):
    """The longest folder of ALLOWED that holds `path` (posix, relative to the root), or None."""
    best = None
    for folder in ALLOWED:
        if path.startswith(folder + "/") and (best is None or len(folder) > len(best)):
            best = folder
    return best


def check(root):
    faults = []
    for path in sorted(root.rglob("*")):
        rel = path.relative_to(root).as_posix()
        if path.suffix not in {".h", ".cpp", ".cc", ".hpp"} or rel.startswith("build/"):
            continue
        here = folder_of(rel)
        if here is None:
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        for match in INCLUDE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            header = match.group(2)
            there = folder_of(header)
            if there and there != here and there not in ALLOWED[here]:
                faults.append(f"{rel}:{line}: {here} must not include {there} ({header})")
            for pattern, homes in CONFINED:
                if there is None or pattern.startswith("flatbuffers"):
                    inside = any(rel.startswith(home + "/") for home in homes)
                    if re.match(pattern, header) and not inside:
                        faults.append(f"{rel}:{line}: {header} stays in {', '.join(sorted(homes))}")
    return faults


def self_test():
    """A test that cannot fail is none: plant faults and see them found."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        (root / "wrinkle").mkdir()
        (root / "client/cpp").mkdir(parents=True)
        (root / "wrinkle/a.h").write_text('#include "wrinkle/b.h"\n#include "render/renderer.h"\n')
        (root / "client/cpp/c.cpp").write_text('#include "wrinkle/skeleton/pose.h"\n#include <glm/vec3.hpp>\n')
        faults = check(root)
        assert len(faults) == 3, faults
        assert faults[2].startswith("wrinkle/a.h:2"), faults
    print("check_includes: self test passed")


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    faults = check(pathlib.Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    print(f"check_includes: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
