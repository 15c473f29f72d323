# SPDX-License-Identifier: Apache-2.0
"""Skinned bodies of boxes as .glb files, with animations. Nothing here uses Furrow."""
import json
import math
import struct

# A body that faces +Z, 1.6 m high: the part, the part above it, its place in metres. Left is +X.
PERSON = (("hips", None, (0, 0.9, 0)), ("spine", "hips", (0, 1.05, 0)), ("chest", "spine", (0, 1.25, 0)),
          ("neck", "chest", (0, 1.42, 0)), ("head", "neck", (0, 1.5, 0)),
          *((f"{part}_{side}", above if above in ("hips", "chest") else f"{above}_{side}", (sign * x, y, z))
            for side, sign in (("l", 1), ("r", -1))
            for part, above, (x, y, z) in (("arm", "chest", (0.18, 1.38, 0)), ("elbow", "arm", (0.44, 1.38, 0)),
                                           ("hand", "elbow", (0.68, 1.38, 0)), ("leg", "hips", (0.1, 0.86, 0)),
                                           ("knee", "leg", (0.1, 0.48, 0)), ("foot", "knee", (0.1, 0.08, -0.02)),
                                           ("toes", "foot", (0.1, 0.02, 0.12)))))
# The joint names of Khronos's sample CesiumMan, whose file is Z up and faces +X.
CESIUM_MAN = {"hips": "Skeleton_torso_joint_1", "spine": "Skeleton_torso_joint_2", "chest": "torso_joint_3",
              "neck": "Skeleton_neck_joint_1", "head": "Skeleton_neck_joint_2",
              "arm_l": "Skeleton_arm_joint_L__4_", "elbow_l": "Skeleton_arm_joint_L__3_",
              "hand_l": "Skeleton_arm_joint_L__2_", "arm_r": "Skeleton_arm_joint_R",
              "elbow_r": "Skeleton_arm_joint_R__2_", "hand_r": "Skeleton_arm_joint_R__3_",
              **{f"{part}_{side.lower()}": f"leg_joint_{side}_{number}" for side in "LR"
                 for part, number in (("leg", 1), ("knee", 2), ("foot", 3), ("toes", 5))}}
VRM = {**{part: part for part in ("hips", "spine", "chest", "neck", "head")},
       **{f"{part}_{side[0]}": side + name for side in ("left", "right")
          for part, name in (("arm", "UpperArm"), ("elbow", "LowerArm"), ("hand", "Hand"), ("leg", "UpperLeg"),
                             ("knee", "LowerLeg"), ("foot", "Foot"), ("toes", "Toes"))}}
TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)


def turn(axis, degrees):
    """A quaternion (x, y, z, w)."""
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) * a for a in axis) + (math.cos(half),)


def times(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def inverse(q):
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q, v):
    return times(times(q, (*v, 0.0)), inverse(q))[:3]


def kick(degrees=60.0):
    """Turns about axes of the body, by part and time: the left knee flexes, the right arm drops, the head nods."""
    share = (0.0, 0.5, 1.0, 0.5, 0.0)
    return {"knee_l": [turn((1, 0, 0), degrees * s) for s in share],
            "arm_r": [turn((0, 0, 1), degrees * s) for s in share],
            "head": [turn((1, 0, 0), 0.3 * degrees * s) for s in share]}


class Body:
    """`names`: the joint of each part. `facing`: +X of the file instead of +Z, with Z up, as in CesiumMan's."""

    def __init__(self, names=None, parts=PERSON, z_up=False, moves=None):
        self.parts, self.z_up, self.moves = parts, z_up, moves or {}
        self.names = names or {part: part for part, *_ in parts}
        self.index = {part: i for i, (part, *_) in enumerate(parts)}
        # From the body's axes to the file's: its +Z becomes +X, its +Y becomes +Z.
        self.axes = times(turn((0, 0, 1), 90), turn((1, 0, 0), 90)) if z_up else turn((1, 0, 0), 0)
        # Every joint has axes of its own, as exporters write them.
        self.rest = [times(self.axes, turn((0, 0, 1), 90 + 7 * i)) if z_up else self.axes for i in range(len(parts))]
        self.at = [rotate(self.axes, place) for _, _, place in parts]
        self.binary, self.views, self.accessors = bytearray(), [], []

    def add(self, code, rows, kind, component, **limits):
        data = b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows)
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows),
                               "type": kind, **limits})
        return len(self.accessors) - 1

    def nodes(self):
        nodes = []
        for i, (part, above, _) in enumerate(self.parts):
            up = self.index.get(above)
            turned, origin = (self.rest[up], self.at[up]) if up is not None else ((0, 0, 0, 1), (0, 0, 0))
            offset = [a - b for a, b in zip(self.at[i], origin)]
            nodes.append({"name": self.names[part], "translation": rotate(inverse(turned), offset),
                          "rotation": times(inverse(turned), self.rest[i])})
            below = [k for k, (_, parent, _) in enumerate(self.parts) if parent == part]
            if below:
                nodes[-1]["children"] = below
        return nodes

    def boxes(self):
        """A box from each joint towards the part above it; the UVs do not overlap."""
        positions, normals, uvs, joints, weights, indices = [], [], [], [], [], []
        corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        for i, (part, above, place) in enumerate(self.parts):
            for f, face in enumerate(faces):
                normal = [sum(corners[c][axis] for c in face) / 4 for axis in range(3)]
                base = len(positions)
                for k, corner in enumerate(face):
                    size = (0.09, 0.09, 0.06) if part in ("hips", "chest", "head") else (0.045, 0.045, 0.045)
                    spot = [p + s * c for p, s, c in zip(place, size, corners[corner])]
                    positions.append(rotate(self.axes, spot))
                    normals.append(rotate(self.axes, normal))
                    u, v = (i * 6 + f) % 12, (i * 6 + f) // 12
                    uvs.append(((u + 0.1 + 0.8 * (k in (1, 2))) / 12, (v + 0.1 + 0.8 * (k > 1)) / 12))
                    joints.append((i, self.index.get(above, i), 0, 0))
                    weights.append((0.75, 0.25, 0, 0) if above else (1, 0, 0, 0))
                indices += [(base,), (base + 1,), (base + 2,), (base,), (base + 2,), (base + 3,)]
        return positions, normals, uvs, joints, weights, indices

    def matrices(self):
        """Inverse bind matrices, column by column."""
        rows = []
        for turned, at in zip(self.rest, self.at):
            back = inverse(turned)
            columns = [rotate(back, axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
            place = rotate(back, [-a for a in at])
            rows.append([n for column in columns for n in (*column, 0)] + [*place, 1])
        return rows

    def animation(self):
        channels, samplers = [], []
        time = self.add("f", [(t,) for t in TIMES], "SCALAR", 5126, min=[TIMES[0]], max=[TIMES[-1]])
        for part, turns in self.moves.items():
            i = self.index[part]
            rest = self.nodes()[i]["rotation"]
            keys = []
            for q in turns:
                in_file = times(times(self.axes, q), inverse(self.axes))
                keys.append(times(rest, times(inverse(self.rest[i]), times(in_file, self.rest[i]))))
            samplers.append({"input": time, "output": self.add("f", keys, "VEC4", 5126)})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": i, "path": "rotation"}})
        return {"channels": channels, "samplers": samplers}

    def root(self):
        """The glTF document; `binary` is complete afterwards."""
        nodes = self.nodes()
        positions, normals, uvs, joints, weights, indices = self.boxes()
        span = [(min(axis), max(axis)) for axis in zip(*positions)]
        primitive = {"attributes": {
            "POSITION": self.add("f", positions, "VEC3", 5126, min=[a for a, _ in span], max=[b for _, b in span]),
            "NORMAL": self.add("f", normals, "VEC3", 5126), "TEXCOORD_0": self.add("f", uvs, "VEC2", 5126),
            "JOINTS_0": self.add("B", joints, "VEC4", 5121), "WEIGHTS_0": self.add("f", weights, "VEC4", 5126)},
            "indices": self.add("H", indices, "SCALAR", 5123), "material": 0}
        skin = {"joints": list(range(len(nodes))), "inverseBindMatrices": self.add("f", self.matrices(), "MAT4", 5126)}
        root = {"asset": {"version": "2.0"}, "scene": 0, "meshes": [{"name": "body", "primitives": [primitive]}],
                "skins": [skin], "materials": [{"name": "shirt"}]}
        if self.moves:
            root["animations"] = [self.animation()]
        armature = {"name": "Armature", "children": [0]}
        top = [len(nodes), len(nodes) + 1]
        nodes += [armature, {"name": "mesh", "mesh": 0, "skin": 0}]
        if self.z_up:
            nodes.append({"name": "Z_UP", "children": top, "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]})
            top = [len(nodes) - 1]
        root |= {"nodes": nodes, "scenes": [{"nodes": top}], "bufferViews": self.views, "accessors": self.accessors}
        root["buffers"] = [{"byteLength": len(self.binary)}]
        return root

    def save(self, path):
        """Writes a .glb, or a .gltf with its buffer beside it."""
        root = self.root()
        if path.suffix == ".gltf":
            buffer = path.with_suffix(".bin")
            buffer.write_bytes(bytes(self.binary))
            root["buffers"][0]["uri"] = buffer.name
            path.write_text(json.dumps(root))
            return path
        self.binary += b"\0" * (-len(self.binary) % 4)
        text = json.dumps(root).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)) +
                         struct.pack("<I4s", len(text), b"JSON") + text +
                         struct.pack("<I4s", len(self.binary), b"BIN\0") + bytes(self.binary))
        return path
