#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the structure of the C++ sources (docs/ARCHITECTURE.md).

    check_includes.py ROOT          check the sources below ROOT
    check_includes.py --self-test   plant one fault of each kind and check that it is found

Rules:
1. Direction. DIRECT lists the folders that each folder may include. Whatever those may include is allowed too.
2. Foreign headers. CONFINED lists the folders that may include a library's headers.
3. Units. No include cycle between units. A unit is a header with its source: x.h, x-inl.h and x.cpp are one unit.
4. Folders. No include cycle between folders. Every folder counts by itself, so a folder and its subfolder form a
   cycle if each includes the other.
5. Size. At most MAX_FILES headers and sources per folder, without its subfolders.

Rules 3 to 5 apply to all code except tests/, bench/ and third_party/.
"""
import collections
import pathlib
import re
import sys
import tempfile

# Folder -> the folders it may include besides itself and base/. The longest matching prefix applies.
DIRECT = {
    "base": set(),
    "wrinkle": set(),
    "protocol": set(),
    "gltf": set(),
    "report": set(),
    "rig": {"wrinkle"},
    "motion": {"wrinkle", "gltf"},
    "character": {"wrinkle", "rig", "gltf"},
    "recording": {"wrinkle", "protocol", "motion"},
    "render": {"wrinkle", "character", "rig"},
    "authoring": {"wrinkle", "gltf", "report", "rig", "motion", "character", "recording", "render"},
    "server": {"wrinkle", "protocol", "gltf", "report", "rig", "motion", "character", "recording", "render"},
    "client/cpp": {"protocol"},
    "client/c": {"protocol", "client/cpp"},
    "client/engines": {"client/c"},
    "client/net": {"protocol", "client/cpp"},
    "client/chaos": {"protocol", "report", "client/cpp", "client/net"},
    "client/load": {"wrinkle", "protocol", "report", "client/cpp", "client/net"},
    "client/plan": {"protocol", "report"},
    "client/cli": {"wrinkle", "protocol", "gltf", "report", "rig", "motion", "character", "recording", "render",
                   "authoring", "client/cpp", "client/load", "client/plan", "client/chaos", "client/net"},
}
# Exceptions from "whatever those may include": never, even though a permitted folder may.
NEVER = {("authoring", "protocol")}

# Foreign header (a pattern for its beginning) -> the folders that may include it.
GLM = {"wrinkle", "rig", "gltf", "motion", "recording", "character", "render", "authoring", "server", "client/load",
       "client/cli"}
CONFINED = [
    (r"(epoxy|GL|EGL|GLES\d)/", {"render"}),
    (r"flatbuffers/|.*_generated\.h$", {"protocol", "base", "rig", "authoring/bake", "recording"}),
    (r".*_bfbs\.h$", {"recording"}),
    (r"asio(\.hpp|/)", {"server", "client/cpp", "client/net"}),
    (r"boost/", {"server/http"}),
    (r"prometheus/", {"server/http"}),
    (r"glm/", GLM),
    (r"hwy/", {"wrinkle", "render"}),
    (r"OpenImageIO/", {"character/pictures/oiio"}),
    (r"turbojpeg\.h", {"render"}),
    (r"spdlog/", {"server"}),
    (r"CLI/", {"server/config", "client/cli", "authoring/generator"}),
    (r"toml\+\+/", {"server/config", "render/settings"}),
    (r"nlohmann/", {"rig", "gltf", "motion", "character", "authoring", "server/http", "client"}),
    (r"(tiny_gltf\.h|third_party/tinygltf/)", {"gltf"}),
    (r"assimp/", {"authoring/assimp"}),
    (r"sodium(\.h|/)", {"protocol/secure/crypto"}),
    (r"nats/", {"server/cluster/nats"}),
    (r"openssl/", {"server/tls", "client/cpp"}),
    (r"(zstd|lz4frame)\.h", {"motion/mcap"}),
]

MAX_FILES = 25
CODE = {".h", ".hpp", ".cpp", ".cc"}
NOT_CODE = ("build/", "tests/", "bench/", "docs/", "third_party/", ".git/")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def reachable(direct):
    """Folder -> every folder it may include, directly or through others."""
    allowed = {}

    def visit(folder):
        if folder not in allowed:
            allowed[folder] = {"base"} | direct[folder]
            for other in direct[folder]:
                allowed[folder] |= visit(other)
        return allowed[folder]

    for folder in direct:
        visit(folder)
    return {folder: {other for other in others if (folder, other) not in NEVER}
            for folder, others in allowed.items()}


ALLOWED = reachable(DIRECT)


def is_inside(path, folder):
    return path.startswith(folder + "/")


def rule_folder(path):
    """The longest folder of DIRECT that holds `path` (relative to the root), or None."""
    return max((folder for folder in DIRECT if is_inside(path, folder)), key=len, default=None)


def folder_name(path):
    return path.rsplit("/", 1)[0] if "/" in path else "."


def unit_name(path):
    return re.sub(r"(-inl)?\.\w+$", "", path)


def read_sources(root):
    """Path -> [(line, header, is_system)] for every header and source that the rules apply to."""
    sources = {}
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix in CODE and not name.startswith(NOT_CODE):
            text = path.read_text(encoding="utf-8", errors="replace")
            sources[name] = [(text.count("\n", 0, match.start(1)) + 1, match.group(2), match.group(1) == "<")
                             for match in INCLUDE.finditer(text)]
    return sources


def resolve(name, header, sources):
    """The path of our header that `name` includes, or None for a foreign or generated header."""
    if header in sources:
        return header
    beside = f"{folder_name(name)}/{header}"
    return beside if beside in sources else None


def check_directions(sources):
    for name, includes in sources.items():
        here = rule_folder(name)
        if here is None:
            yield f"{name}: the folder is not in the direction table"
            continue
        for line, header, _ in includes:
            there = rule_folder(header)
            if there and there != here and there not in ALLOWED[here]:
                yield f"{name}:{line}: {here} must not include {there} ({header})"


def check_foreign_headers(sources):
    for name, includes in sources.items():
        for line, header, _ in includes:
            if header in sources:
                continue
            for pattern, homes in CONFINED:
                if re.match(pattern, header) and not any(is_inside(name, home) for home in homes):
                    yield f"{name}:{line}: {header} may be included only in {', '.join(sorted(homes))}"


def check_sizes(sources):
    for folder, count in sorted(collections.Counter(map(folder_name, sources)).items()):
        if count > MAX_FILES:
            yield f"{folder}: {count} headers and sources, at most {MAX_FILES} are allowed"


def include_graph(sources, node_of):
    """Node -> {included node: "file:line" of one such include}."""
    graph = collections.defaultdict(dict)
    for name, includes in sources.items():
        for line, header, _ in includes:
            target = resolve(name, header, sources)
            if target and node_of(target) != node_of(name):
                graph[node_of(name)].setdefault(node_of(target), f"{name}:{line}")
    return graph


def strong_components(graph):
    """Groups of two or more nodes that all reach each other (Tarjan's algorithm)."""
    index, low, stack, on_stack, groups = {}, {}, [], set(), []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        on_stack.add(node)
        for other in graph.get(node, ()):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in on_stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            group = set()
            while node not in group:
                group.add(stack.pop())
            on_stack.difference_update(group)
            if len(group) > 1:
                groups.append(group)

    sys.setrecursionlimit(100_000)
    for node in list(graph):
        if node not in index:
            visit(node)
    return groups


def shortest_cycle(graph, group):
    """The nodes of a shortest cycle through the alphabetically first node of `group`."""
    start = min(group)
    came_from, queue = {start: None}, collections.deque([start])
    while queue:
        node = queue.popleft()
        if start in graph[node]:
            path = [start]
            while node is not None:
                path.append(node)
                node = came_from[node]
            return path[::-1]
        for other in graph[node]:
            if other in group and other not in came_from:
                came_from[other] = node
                queue.append(other)
    raise AssertionError("the group has no cycle")


def check_cycles(sources, kind, node_of):
    graph = include_graph(sources, node_of)
    for group in strong_components(graph):
        path = shortest_cycle(graph, group)
        places = ", ".join(graph[a][b] for a, b in zip(path, path[1:]))
        yield f"{kind} cycle of {len(group)}: {' -> '.join(path)} (includes at {places})"


def check(root):
    sources = read_sources(root)
    return [*check_directions(sources), *check_foreign_headers(sources), *check_sizes(sources),
            *check_cycles(sources, "unit", unit_name), *check_cycles(sources, "folder", folder_name)]


# --- Self-test -------------------------------------------------------------------------------------------


def faults_of(files):
    """The faults of a tree with these files: path -> headers that the file includes."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for path, headers in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            lines = (f"#include {h}" if h[0] == "<" else f'#include "{h}"' for h in headers)
            (root / path).write_text("// A comment.\n" + "".join(line + "\n" for line in lines))
        return check(root)


def self_test():
    """Each case: what it plants, the files, and the beginnings of the faults that check() must report."""
    cases = [
        ("a sound tree",
         {"base/status.h": [], "wrinkle/skeleton/pose.h": ["base/status.h", "<glm/vec3.hpp>"],
          "rig/rig.h": ["wrinkle/skeleton/pose.h"], "rig/rig.cpp": ["rig/rig.h", "rig/rig_generated.h"],
          "gltf/reader.cpp": ["<tiny_gltf.h>"], "render/scene/scene.h": ["character/character.h"],
          "character/character.h": ["gltf/mesh.h", "rig/rig.h"], "gltf/mesh.h": []}, []),
        ("an upward include", {"wrinkle/a.h": ["render/renderer.h"]},
         ["wrinkle/a.h:2: wrinkle must not include render"]),
        ("an include from base", {"base/a.h": ["wrinkle/b.h"]}, ["base/a.h:2: base must not include wrinkle"]),
        ("a sibling", {"protocol/a.h": ["wrinkle/b.h"]}, ["protocol/a.h:2: protocol must not include wrinkle"]),
        ("an include through a permitted folder", {"render/a.h": ["gltf/b.h"]}, []),
        ("a forbidden include through a permitted folder", {"authoring/a.h": ["protocol/codec/codec.h"]},
         ["authoring/a.h:2: authoring must not include protocol"]),
        ("a daemon that includes the offline tools", {"server/a.h": ["authoring/bake/bake.h"]},
         ["server/a.h:2: server must not include authoring"]),
        ("a client that includes the solver", {"client/cpp/c.cpp": ["wrinkle/skeleton/pose.h"]},
         ["client/cpp/c.cpp:2: client/cpp must not include wrinkle"]),
        ("an unknown folder", {"attic/a.h": []}, ["attic/a.h: the folder is not in the direction table"]),
        ("a foreign header", {"client/cpp/c.cpp": ["<glm/vec3.hpp>"], "protocol/a.cpp": ["<epoxy/gl.h>"]},
         ["client/cpp/c.cpp:2: glm/vec3.hpp may be included only in",
          "protocol/a.cpp:2: epoxy/gl.h may be included only in render"]),
        ("generated FlatBuffers headers", {"server/net/a.cpp": ["protocol/schema/pose_generated.h"]},
         ["server/net/a.cpp:2: protocol/schema/pose_generated.h may be included only in"]),
        ("a full folder", {f"wrinkle/simd/f{i}.h": [] for i in range(26)},
         ["wrinkle/simd: 26 headers and sources, at most 25 are allowed"]),
        ("a folder at the limit", {f"wrinkle/simd/f{i}.h": [] for i in range(25)}, []),
        ("a cycle of units through their sources",
         {"wrinkle/a.h": [], "wrinkle/a.cpp": ["wrinkle/a.h", "wrinkle/b.h"], "wrinkle/b.h": [],
          "wrinkle/b.cpp": ["wrinkle/a.h"]},
         ["unit cycle of 2: wrinkle/a -> wrinkle/b -> wrinkle/a (includes at wrinkle/a.cpp:3, wrinkle/b.cpp:2)"]),
        ("a cycle of units through an -inl.h and a header beside it",
         {"wrinkle/a-inl.h": ["b.h"], "wrinkle/b.h": ["wrinkle/c.h"], "wrinkle/c.h": ["wrinkle/a.h"],
          "wrinkle/a.h": []},
         ["unit cycle of 3: wrinkle/a -> wrinkle/b -> wrinkle/c -> wrinkle/a"]),
        ("a cycle of subfolders without a cycle of units",
         {"render/scene/a.h": ["render/passes/b.h"], "render/passes/b.h": [],
          "render/passes/c.h": ["render/scene/d.h"], "render/scene/d.h": []},
         ["folder cycle of 2: render/passes -> render/scene -> render/passes"]),
        ("a cycle of a folder and its subfolder",
         {"render/a.h": ["render/gl/b.h"], "render/gl/b.h": [], "render/gl/c.h": ["render/d.h"], "render/d.h": []},
         ["folder cycle of 2: render -> render/gl -> render"]),
        ("code that the rules do not cover",
         {"tests/a.h": ["render/b.h", "tests/c.h"], "tests/c.h": ["tests/a.h"], "bench/d.cpp": ["<epoxy/gl.h>"]}, []),
    ]
    for planted, files, expected in cases:
        faults = faults_of(files)
        assert len(faults) == len(expected), f"{planted}: {faults}"
        for beginning in expected:
            assert any(fault.startswith(beginning) for fault in faults), f"{planted}: {faults}"
    print(f"check_includes: self-test passed, {len(cases)} cases")


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    if len(sys.argv) != 2:
        print("usage: check_includes.py ROOT | --self-test", file=sys.stderr)
        return 2
    faults = check(pathlib.Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    print(f"check_includes: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
