# SPDX-License-Identifier: Apache-2.0
"""Forward kinematics of FBX and GLB files, worked out from the files' own properties.

Nothing here uses Furrow or assimp. The formula is that of the FBX SDK's manual ("Computing transformation
matrices"): T * Roff * Rp * Rpre * R * Rpost^-1 * Rp^-1 * Soff * Sp * S * Sp^-1.
"""
import bisect
import json
import math
import re
import struct
import zlib

TICKS = 46186158000  # per second
ORDERS = ("xyz", "xzy", "yzx", "yxz", "zxy", "zyx")  # by RotationOrder; the first axis is applied first


# --- Matrices: rows of four numbers ----------------------------------------------------------------------


def identity():
    return [[float(row == column) for column in range(4)] for row in range(4)]


def product(*matrices):
    result = identity()
    for m in matrices:
        result = [[sum(row[k] * m[k][c] for k in range(4)) for c in range(4)] for row in result]
    return result


def moved(v):
    m = identity()
    for axis in range(3):
        m[axis][3] = v[axis]
    return m


def scaled(v):
    m = identity()
    for axis in range(3):
        m[axis][axis] = v[axis]
    return m


def turned(axis, degrees):
    m, angle = identity(), math.radians(degrees)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m[i][i] = m[j][j] = math.cos(angle)
    m[i][j], m[j][i] = -math.sin(angle), math.sin(angle)
    return m


def from_euler(degrees, order="xyz"):
    first, second, third = ("xyz".index(axis) for axis in order)
    return product(turned(third, degrees[third]), turned(second, degrees[second]), turned(first, degrees[first]))


def from_quaternion(q):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0], [0, 0, 0, 1]]


def transposed_rotation(m):
    return [[m[c][r] if r < 3 and c < 3 else float(r == c) for c in range(4)] for r in range(4)]


def position(m):
    return [m[axis][3] for axis in range(3)]


def axes(m):
    """Returns the directions of the three axes, without their lengths."""
    columns = [[m[r][c] for r in range(3)] for c in range(3)]
    return [[x / (math.hypot(*column) or 1) for x in column] for column in columns]


def difference(a, b):
    """Returns the largest difference of two matrices' positions, and of their axes."""
    return (max(abs(x - y) for x, y in zip(position(a), position(b))),
            max(abs(x - y) for u, v in zip(axes(a), axes(b)) for x, y in zip(u, v)))


# --- FBX files: a node is (name, values, children) -------------------------------------------------------


def parse_binary(data):
    wide = struct.unpack_from("<I", data, 23)[0] >= 7500

    def array(at):
        kind = chr(data[at])
        count, packed, size = struct.unpack_from("<III", data, at + 1)
        content = data[at + 13:at + 13 + size]
        content = zlib.decompress(content) if packed else content
        return list(struct.unpack(f"<{count}{dict(f='f', d='d', l='q', i='i', b='?')[kind]}", content)), at + 13 + size

    def value(at):
        kind = chr(data[at])
        if kind in "SR":
            size = struct.unpack_from("<I", data, at + 1)[0]
            return data[at + 5:at + 5 + size].decode("latin1"), at + 5 + size
        if kind in "fdlib":
            return array(at)
        form = "<" + dict(Y="h", C="?", I="i", F="f", D="d", L="q")[kind]
        return struct.unpack_from(form, data, at + 1)[0], at + 1 + struct.calcsize(form)

    def node(at):
        form = "<QQQB" if wide else "<IIIB"
        end, count, _, length = struct.unpack_from(form, data, at)
        at += struct.calcsize(form)
        name, values, children = data[at:at + length].decode("latin1"), [], []
        at += length
        if end == 0:
            return None, at
        for _ in range(count):
            one, at = value(at)
            values.append(one)
        while at < end:
            child, at = node(at)
            if child is None:
                break
            children.append(child)
        return (name, values, children), end

    nodes, at = [], 27
    while True:
        found, at = node(at)
        if found is None:
            return nodes
        nodes.append(found)


def parse_ascii(text):
    tokens = re.findall(r'"[^"]*"|[{}:,]|[^\s{}:,"]+', re.sub(r"^\s*;.*$", "", text, flags=re.M))

    def number(token):
        return int(token) if re.fullmatch(r"-?\d+", token) else float(token)

    def nodes(at):
        result = []
        while at < len(tokens) and tokens[at] != "}":
            name, values, children = tokens[at], [], []
            at += 2  # the name and its colon
            while at < len(tokens) and tokens[at] not in "{}" and tokens[at + 1:at + 2] != [":"]:
                if tokens[at].startswith('"'):
                    values.append(tokens[at][1:-1])
                elif tokens[at] != "," and tokens[at][0] != "*":
                    values.append(number(tokens[at]) if tokens[at][0] in "-.0123456789" else tokens[at])
                at += 1
            if at < len(tokens) and tokens[at] == "{":
                children, at = nodes(at + 1)
                at += 1
            # "KeyTime: *2 { a: 1,2 }" is one list.
            result.append((name, [children[0][1]], []) if children and children[0][0] == "a" else (name, values, children))
        return result, at

    return nodes(0)[0]


def properties(node):
    return {p[1][0]: p[1][4:] for block in node[2] if block[0] == "Properties70" for p in block[2]}


def child(node, name):
    return next((c for c in node[2] if c[0] == name), None)


class Fbx:
    """The models and takes of an FBX file, version 7."""

    def __init__(self, data):
        self.nodes = parse_binary(data) if data.startswith(b"Kaydara") else parse_ascii(data.decode("latin1"))
        top = {node[0]: node for node in self.nodes}
        self.objects = {o[1][0]: o for o in top["Objects"][2] if len(o[1]) > 1}
        self.connections = [c[1] for c in top["Connections"][2]]
        self.settings = properties(top["GlobalSettings"])
        self.defaults = {}
        for kind in top["Definitions"][2] if "Definitions" in top else ():
            template = child(kind, "PropertyTemplate")
            if kind[0] == "ObjectType" and kind[1][0] == "Model" and template:
                self.defaults = properties(template)
        self.models = {key: self.name(key) for key, o in self.objects.items() if o[0] == "Model"}
        self.parents = {c[1]: c[2] for c in self.connections
                        if c[0] == "OO" and c[1] in self.models and c[2] in self.models}
        self.takes = [key for key, o in self.objects.items() if o[0] == "AnimationStack"]

    def name(self, key):
        return self.objects[key][1][1].split("\0")[0].split("::", 1)[-1]

    def start(self, take):
        """Returns the time that is 0 of a take, in seconds."""
        stated = properties(self.objects[take])
        if "LocalStart" in stated or "LocalStop" in stated:
            return stated.get("LocalStart", [0])[0] / TICKS
        return min(times[0] for times, _ in self.curves(take).values())

    def curves(self, take):
        """(model, property, "d|X") -> (times in seconds, values)."""
        def sources(owners, kind):
            return [c[1] for c in self.connections
                    if c[0] == "OO" and c[2] in owners and self.objects.get(c[1], [""])[0] == kind]
        moved_by = set(sources(sources([take], "AnimationLayer"), "AnimationCurveNode"))
        targets = {c[1]: (c[2], c[3]) for c in self.connections if c[0] == "OP" and c[1] in moved_by}
        result = {}
        for c in self.connections:
            if c[0] == "OP" and c[2] in targets and self.objects.get(c[1], [""])[0] == "AnimationCurve":
                curve = self.objects[c[1]]
                result[(*targets[c[2]], c[3])] = ([t / TICKS for t in child(curve, "KeyTime")[1][0]],
                                                 child(curve, "KeyValueFloat")[1][0])
        return result

    def value(self, model, name, default, curves, time):
        stated = properties(self.objects[model]).get(name, self.defaults.get(name, default))
        result = [float(x) for x in stated[:3]]
        for axis, letter in enumerate("XYZ"):
            if time is not None and (model, name, "d|" + letter) in curves:
                result[axis] = interpolated(*curves[model, name, "d|" + letter], time)
        return result

    def local(self, model, curves, time):
        def vector(name, default=(0, 0, 0)):
            return self.value(model, name, default, curves, time)

        def inverse(v):
            return [-x for x in v]
        order = ORDERS[int(properties(self.objects[model]).get("RotationOrder", [0])[0])]
        pivot, scaling_pivot = vector("RotationPivot"), vector("ScalingPivot")
        return product(moved(vector("Lcl Translation")), moved(vector("RotationOffset")), moved(pivot),
                       from_euler(vector("PreRotation")), from_euler(vector("Lcl Rotation"), order),
                       transposed_rotation(from_euler(vector("PostRotation"))), moved(inverse(pivot)),
                       moved(vector("ScalingOffset")), moved(scaling_pivot),
                       scaled(vector("Lcl Scaling", (1, 1, 1))), moved(inverse(scaling_pivot)))

    def model_space(self, curves, time):
        """Name -> matrix of every model, in metres and Y up. `time` None: without animation."""
        metres = float(self.settings.get("UnitScaleFactor", [1])[0]) * 0.01
        up, sign = (int(self.settings.get(name, [1])[0]) for name in ("UpAxis", "UpAxisSign"))
        space = {0: turned(2, 90 * sign), 1: identity(), 2: turned(0, -90 * sign)}[up]
        matrices = {}

        def matrix(model):
            if model not in matrices:
                above = matrix(self.parents[model]) if model in self.parents else product(space, scaled([metres] * 3))
                matrices[model] = product(above, self.local(model, curves, time))
            return matrices[model]
        return {name: matrix(model) for model, name in self.models.items()}


def interpolated(times, values, time):
    """Linear between keys."""
    at = bisect.bisect_right(times, time)
    if at in (0, len(times)):
        return values[min(at, len(times) - 1)]
    share = (time - times[at - 1]) / (times[at] - times[at - 1])
    return values[at - 1] + (values[at] - values[at - 1]) * share


# --- GLB files -------------------------------------------------------------------------------------------


class Glb:
    """The nodes and the animation of a GLB that Furrow wrote."""

    def __init__(self, data):
        size = struct.unpack_from("<I", data, 12)[0]
        self.json, self.binary = json.loads(data[20:20 + size]), data[28 + size:]
        animation = self.json["animations"][0]
        self.times = [t[0] for t in self.numbers(animation["samplers"][0]["input"])]
        self.tracks = {}
        for channel in animation["channels"]:
            output = animation["samplers"][channel["sampler"]]["output"]
            self.tracks[channel["target"]["node"], channel["target"]["path"]] = self.numbers(output)
        self.parents = {c: i for i, node in enumerate(self.json["nodes"]) for c in node.get("children", ())}

    def numbers(self, accessor):
        about = self.json["accessors"][accessor]
        view, width = self.json["bufferViews"][about["bufferView"]], dict(SCALAR=1, VEC3=3, VEC4=4)[about["type"]]
        flat = struct.unpack_from(f"<{about['count'] * width}f", self.binary, view.get("byteOffset", 0))
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    def model_space(self, frame):
        """Name -> matrix of every node. `frame` None: the rest pose."""
        matrices = {}

        def part(node, path, default):
            if frame is not None and (node, path) in self.tracks:
                return self.tracks[node, path][frame]
            return self.json["nodes"][node].get(path, default)

        def matrix(node):
            if node not in matrices:
                above = matrix(self.parents[node]) if node in self.parents else identity()
                matrices[node] = product(above, moved(part(node, "translation", (0, 0, 0))),
                                         from_quaternion(part(node, "rotation", (0, 0, 0, 1))),
                                         scaled(part(node, "scale", (1, 1, 1))))
            return matrices[node]
        return {node["name"]: matrix(i) for i, node in enumerate(self.json["nodes"])}

    def blend_shapes(self):
        """Name -> values, one per frame."""
        names = [n for mesh in self.json.get("meshes", ()) for n in mesh["extras"]["targetNames"]]
        values = next((v for (_, path), v in self.tracks.items() if path == "weights"), [])
        return {name: [v[0] for v in values[i::len(names)]] for i, name in enumerate(names)}


def worst_difference(fbx, glb, take=0, frames=None):
    """Returns the largest differences of positions (metres) and axes, and the number of compared joints."""
    curves, start = fbx.curves(fbx.takes[take]), fbx.start(fbx.takes[take])
    worst, compared = (0.0, 0.0), 0
    for frame in [None, *(range(len(glb.times)) if frames is None else frames)]:
        expected = fbx.model_space(curves, None if frame is None else glb.times[frame] + start)
        for name, matrix in glb.model_space(frame).items():
            if name in expected:
                compared += 1
                worst = tuple(map(max, worst, difference(expected[name], matrix)))
    return *worst, compared
