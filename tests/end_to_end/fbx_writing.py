# SPDX-License-Identifier: Apache-2.0
"""Writes small FBX 7.4 files, ASCII and binary, as other programs do."""
import itertools
import struct
import zlib

from fbx_testing import TICKS


class List(tuple):
    """Values that FBX stores as one array, with the type of its elements: "d", "f", "i" or "l"."""

    def __new__(cls, kind, values):
        made = super().__new__(cls, values)
        made.kind = kind
        return made


class Long(int):
    """An integer that FBX stores in 64 bits: an id or a time."""

    def __repr__(self):
        return str(int(self))


def node(name, *values):
    """A node; lists among `values` are its children."""
    return (name, [v for v in values if not isinstance(v, list)],
            list(itertools.chain(*(v for v in values if isinstance(v, list)))))


def prop(name, kind, *values):
    return node("P", name, kind, "", "A" if kind.startswith("Lcl") else "", *values)


class Scene:
    """Models, takes and blend shapes, and their connections."""

    def __init__(self, **settings):
        self.settings = dict(UpAxis=1, UpAxisSign=1, FrontAxis=2, FrontAxisSign=1, CoordAxis=0, CoordAxisSign=1,
                             UnitScaleFactor=1.0, TimeMode=6) | settings
        self.objects, self.connections, self.ids = [], [], itertools.count(1000)
        self.models = {}

    def add(self, kind, name, sub, children=()):
        key = Long(next(self.ids))
        # Every object has braces, if only for this.
        self.objects.append(node(kind, key, name, sub, list(children) or [node("Version", 100)]))
        return key

    def connect(self, source, target, by=None):
        self.connections.append(node("C", "OP", source, target, by) if by else node("C", "OO", source, target))

    def model(self, name, parent=None, sub="LimbNode", order=0, **vectors):
        """`vectors`: T, R and S for the Lcl properties, others by their names (PreRotation)."""
        names = dict(T="Lcl Translation", R="Lcl Rotation", S="Lcl Scaling")
        stated = [prop("RotationOrder", "enum", order), prop("RotationActive", "bool", 1)]
        for key, v in vectors.items():
            kind = names.get(key, "Vector3D")
            stated.append(prop(names.get(key, key), kind, *(float(x) for x in v)))
        self.models[name] = self.add("Model", "Model::" + name, sub, [node("Version", 232), node("Properties70", stated)])
        self.connect(self.models[name], self.models[parent] if parent else Long(0))
        return self.models[name]

    def take(self, name, curves, start=None, stop=None):
        """`curves`: (model or channel id, property, {"X": [(seconds, value), ...]})."""
        span = [prop("LocalStart", "KTime", Long(round((start or 0) * TICKS))),
                prop("LocalStop", "KTime", Long(round((stop or 0) * TICKS)))] if stop is not None else []
        stack = self.add("AnimationStack", "AnimStack::" + name, "", [node("Properties70", span)])
        layer = self.add("AnimationLayer", "AnimLayer::BaseLayer", "")
        self.connect(layer, stack)
        for target, what, by_axis in curves:
            key = self.models.get(target, target)
            group = self.add("AnimationCurveNode", "AnimCurveNode::" + what.split()[-1][0], "", [node("Properties70", [])])
            self.connect(group, layer)
            self.connect(group, key, what)
            for axis, keys in by_axis.items():
                curve = self.add("AnimationCurve", "AnimCurve::", "", [
                    node("Default", 0.0), node("KeyVer", 4008),
                    node("KeyTime", List("l", (round(t * TICKS) for t, _ in keys))),
                    node("KeyValueFloat", List("f", (float(v) for _, v in keys))),
                    node("KeyAttrFlags", List("i", [4])), node("KeyAttrDataFloat", List("f", [0.0] * 4)),
                    node("KeyAttrRefCount", List("i", [len(keys)]))])
                self.connect(curve, group, "d|" + axis)

    def face(self, parent, shapes):
        """A mesh of one triangle with blend shapes. Returns name -> id of the channel.

        `shapes`: names, or name -> {full weight in percent: z of the first vertex}, with a shape per in-between.
        """
        model = self.model("Face", parent, sub="Mesh")
        mesh = self.add("Geometry", "Geometry::Face", "Mesh", [
            node("Vertices", List("d", (0.0, 0, 0, 1, 0, 0, 0, 1, 0))),
            node("PolygonVertexIndex", List("i", (0, 1, -3)))])
        self.connect(mesh, model)
        deformer = self.add("Deformer", "Deformer::Face", "BlendShape")
        self.connect(deformer, mesh)
        channels = {}
        for name in shapes:
            depths = shapes[name] if isinstance(shapes, dict) else {100: 1}
            channels[name] = self.add("Deformer", "SubDeformer::" + name, "BlendShapeChannel", [
                node("Version", 100), node("DeformPercent", 0.0),
                node("FullWeights", List("d", (float(weight) for weight in depths)))])
            self.connect(channels[name], deformer)
            for weight, z in depths.items():
                shape = self.add("Geometry", f"Geometry::{name}_{weight}" if len(depths) > 1 else "Geometry::" + name,
                                 "Shape", [node("Indexes", List("i", [0])), node("Vertices", List("d", [0.0, 0.0, float(z)])),
                                           node("Normals", List("d", [0.0, 0.0, 0.0]))])
                self.connect(shape, channels[name])
        return channels

    def nodes(self):
        settings = [prop(name, "double" if isinstance(v, float) else "int", v) for name, v in self.settings.items()]
        return [node("FBXHeaderExtension", [node("FBXHeaderVersion", 1003), node("FBXVersion", 7400),
                                            node("Creator", "a test")]),
                node("GlobalSettings", [node("Version", 1000), node("Properties70", settings)]),
                node("Definitions", [node("Version", 100), node("Count", 0)]),
                node("Objects", self.objects), node("Connections", self.connections)]


def to_ascii(nodes):
    lines = ["; FBX 7.4.0 project file"]

    def text(value):
        return '"' + value + '"' if isinstance(value, str) else repr(value)

    def write(one, indent):
        name, values, children = one
        if values and isinstance(values[0], List):
            lines.append(f"{indent}{name}: *{len(values[0])} {{\n{indent}\ta: {','.join(map(repr, values[0]))}\n{indent}}}")
            return
        lines.append(f"{indent}{name}: {', '.join(map(text, values))}" + (" {" if children or not values else ""))
        if children or not values:
            for c in children:
                write(c, indent + "\t")
            lines.append(indent + "}")

    for one in nodes:
        write(one, "")
    return ("\n".join(lines) + "\n").encode()


def to_binary(nodes):
    def value(v):
        if isinstance(v, List):
            packed = zlib.compress(struct.pack(f"<{len(v)}{dict(l='q').get(v.kind, v.kind)}", *v))
            return v.kind.encode() + struct.pack("<III", len(v), 1, len(packed)) + packed
        if isinstance(v, str):
            # "Model::Hips" is stored as the name, two bytes, and the class.
            kind, _, name = v.rpartition("::")
            content = (name + "\0\1" + kind if kind else v).encode()
            return b"S" + struct.pack("<I", len(content)) + content
        if isinstance(v, float):
            return b"D" + struct.pack("<d", v)
        return b"L" + struct.pack("<q", v) if isinstance(v, Long) else b"I" + struct.pack("<i", v)

    def write(one, at):
        name, values, children = one
        head = 13 + len(name)
        content = b"".join(map(value, values))
        body = b""
        for c in children:
            body += write(c, at + head + len(content) + len(body))
        if children or not values:
            body += bytes(13)
        end = at + head + len(content) + len(body)
        return struct.pack("<IIIB", end, len(values), len(content), len(name)) + name.encode() + content + body

    data = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400)
    for one in nodes:
        data += write(one, len(data))
    return data + bytes(13) + bytes(160)
