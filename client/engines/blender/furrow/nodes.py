# SPDX-License-Identifier: Apache-2.0
"""Builds the wrinkle material of an export (`furrow export --for blender`) out of Blender's nodes, for Cycles and Eevee.

    import nodes
    nodes.build_material("export/wrinkles.json", bpy.context.object)
    bpy.context.object["furrow_brow_l_squash"] = 1.0
    bpy.context.object.update_tag()

Each wrinkle weight is a custom property of the object: "furrow_" and the weight's name, with every character that is no
ASCII letter or digit replaced by "_". A driver carries the property into the material. (An Attribute node of the type
Object would do without a driver, but Eevee of Blender 3.4 passes at most 8 of them to a material.) Call update_tag() on the
object after a script has set properties, so that Blender evaluates the drivers.

The blend is that of Furrow's own renderer: the slopes n.xy / n.z of the base normal map and of all wrinkle maps are added.
"""
import json
import os
import re

import bpy

FORMAT = "furrow-wrinkles"
VERSION = 1
GROUP_PREFIX = "Furrow "
VALUE_PREFIX = "Furrow weight "
MAX_JSON_BYTES = 16 << 20


def property_name(weight):
    """The custom property of a wrinkle weight: "furrow_brow_l_squash" for "brow_l.squash"."""
    return "furrow_" + re.sub(r"[^A-Za-z0-9]", "_", weight)


def load_wrinkles(path):
    """Reads wrinkles.json. Raises ValueError for a file that is not one, or is too new, and OSError."""
    if os.path.getsize(path) > MAX_JSON_BYTES:
        raise ValueError(f"{path}: larger than 16 MiB")
    with open(path, encoding="utf-8") as file:
        wrinkles = json.load(file)
    if not isinstance(wrinkles, dict) or wrinkles.get("format") != FORMAT:
        raise ValueError(f"{path}: not a wrinkles.json; write one with 'furrow export --for blender'")
    if wrinkles.get("version") != VERSION:
        raise ValueError(f"{path}: version {wrinkles.get('version')}, expected {VERSION}; update this add-on")
    if wrinkles["normals"]["green"] != "up":
        raise ValueError(f"{path}: green points down; export with --for blender")
    parts = ("normal", "height", "colour", "cavity", "file", "base_colour", "base_normal", "roughness")
    for entry in wrinkles["maps"] + wrinkles["masks"] + wrinkles["materials"]:
        for file in (entry.get(part) for part in parts):
            if file is not None and (os.path.isabs(file) or os.path.splitdrive(file)[0]
                                     or ".." in re.split(r"[/\\]", file)):
                raise ValueError(f"{path}: the file {file!r} lies outside the export's folder")
    return wrinkles


def set_weights(obj, names, values):
    """Sets the wrinkle weights of an object. Weights without a property of the object are ignored."""
    for name, value in zip(names, values):
        key = property_name(name)
        if key in obj:
            obj[key] = float(value)
    obj.update_tag()


def build_material(wrinkles_json_path, obj, material=None, entry=None):
    """Gives the materials of `obj` their wrinkles, and the object its custom properties.

    Without `material`, every material of the object whose name is that of an entry in wrinkles.json gets this entry's
    wrinkles ("skin.001" counts as "skin"). `material` and `entry` (a name in wrinkles.json) name one pair instead. A
    material that other objects use is copied first, because the drivers belong to one object.

    Returns the materials by the names of their entries. A second call replaces the nodes of the first. Raises ValueError
    if nothing fits, and the errors of load_wrinkles().
    """
    wrinkles = load_wrinkles(wrinkles_json_path)
    folder = os.path.dirname(os.path.abspath(wrinkles_json_path))
    entries = {e["name"]: e for e in wrinkles["materials"]}
    built = {}
    for slot in obj.material_slots:
        if slot.material is None or (material is not None and slot.material != material):
            continue
        name = entry if material is not None and entry else _entry_name(slot.material.name, entries)
        if name not in entries:
            continue
        if slot.material.users > 1:
            slot.material = slot.material.copy()
        _add_properties(obj, wrinkles, entries[name])
        _build(slot.material, obj, wrinkles, entries[name], folder)
        built[name] = slot.material
    if not built:
        raise ValueError(f"{obj.name}: no material has one of the names {', '.join(sorted(entries))}")
    return built


def _entry_name(material_name, entries):
    """Blender appends ".001" to names that are taken."""
    return material_name if material_name in entries else re.sub(r"\.\d+$", "", material_name)


def _add_properties(obj, wrinkles, entry):
    for index in entry["weights"]:
        weight = wrinkles["weights"][index]
        key = property_name(weight["name"])
        if key not in obj:
            obj[key] = 0.0
        obj.id_properties_ui(key).update(min=0.0, max=1.0, soft_min=0.0, soft_max=1.0, default=0.0,
                                         description=f"Wrinkle weight {weight['name']}")


def _build(material, obj, wrinkles, entry, folder):
    material.use_nodes = True
    tree = material.node_tree
    _remove_old(tree)
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree = _Group(wrinkles, entry, folder).tree
    group.name = group.label = GROUP_PREFIX + entry["name"]
    group.location = (-500, -200)
    group.width = 240
    for row, index in enumerate(entry["weights"]):
        name = wrinkles["weights"][index]["name"]
        value = tree.nodes.new("ShaderNodeValue")
        value.name = value.label = VALUE_PREFIX + name
        value.hide = True
        value.location = (-760, -40 * row)
        _drive(value.outputs[0], obj, property_name(name))
        tree.links.new(value.outputs[0], group.inputs[name])
    _connect(tree, group)


def _remove_old(tree):
    """Removes what an earlier call has built. Links that it has taken over are restored."""
    for node in [n for n in tree.nodes if n.name.startswith((GROUP_PREFIX, VALUE_PREFIX))]:
        if node.name.startswith(GROUP_PREFIX) and node.type == "MIX_RGB" and node.inputs[1].is_linked:
            source = node.inputs[1].links[0].from_socket
            for link in list(node.outputs[0].links):
                tree.links.new(source, link.to_socket)
        if node.type == "VALUE":
            node.outputs[0].driver_remove("default_value")
        group = node.node_tree if node.type == "GROUP" else None
        tree.nodes.remove(node)
        if group is not None and group.users == 0:
            bpy.data.node_groups.remove(group)


def _drive(socket, obj, key):
    curve = socket.driver_add("default_value")
    curve.driver.type = "AVERAGE"  # of one variable: its value, without a Python expression
    variable = curve.driver.variables.new()
    variable.type = "SINGLE_PROP"
    target = variable.targets[0]
    target.id_type = "OBJECT"
    target.id = obj
    target.data_path = f'["{key}"]'


def _connect(tree, group):
    """Connects the group to the material's Principled BSDF, if it has one."""
    shader = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    if shader is None:
        return
    tree.links.new(group.outputs["Normal"], shader.inputs["Normal"])
    colour = shader.inputs["Base Color"]
    tint = tree.nodes.new("ShaderNodeMixRGB")
    tint.name = tint.label = GROUP_PREFIX + "tint"
    tint.blend_type = "MULTIPLY"
    tint.inputs[0].default_value = 1.0
    tint.location = (-220, 160)
    if colour.is_linked:
        tree.links.new(colour.links[0].from_socket, tint.inputs[1])
    else:
        tint.inputs[1].default_value = colour.default_value
    tree.links.new(group.outputs["Colour"], tint.inputs[2])
    tree.links.new(tint.outputs[0], colour)
    if "Specular" in shader.inputs:  # "Specular IOR Level" from Blender 4.0 on
        specular = shader.inputs["Specular"]
    else:
        specular = shader.inputs["Specular IOR Level"]
    if not specular.is_linked:
        gloss = tree.nodes.new("ShaderNodeMath")
        gloss.name = gloss.label = GROUP_PREFIX + "gloss"
        gloss.operation = "MULTIPLY"
        gloss.location = (-220, -60)
        gloss.inputs[1].default_value = specular.default_value
        tree.links.new(group.outputs["Cavity"], gloss.inputs[0])
        tree.links.new(gloss.outputs[0], specular)


class _Group:
    """The node group of a material: weights in; normal, colour factor and cavity factor out."""

    def __init__(self, wrinkles, entry, folder):
        self.folder = folder
        self.tree = bpy.data.node_groups.new(GROUP_PREFIX + entry["name"], "ShaderNodeTree")
        self.column = 0
        self.row = 0
        self.uv = self._node("ShaderNodeUVMap")
        weights = [wrinkles["weights"][i] for i in entry["weights"]]
        for weight in weights:
            self._socket("NodeSocketFloat", weight["name"], is_output=False)
        self._socket("NodeSocketVector", "Normal", is_output=True)
        self._socket("NodeSocketColor", "Colour", is_output=True)
        self._socket("NodeSocketFloat", "Cavity", is_output=True)
        self.input = self._node("NodeGroupInput")
        self._build(wrinkles, entry, weights)

    def _socket(self, kind, name, is_output):
        if hasattr(self.tree, "interface"):  # Blender 4.0 and later
            self.tree.interface.new_socket(name, in_out="OUTPUT" if is_output else "INPUT", socket_type=kind)
        else:
            (self.tree.outputs if is_output else self.tree.inputs).new(kind, name)

    def _node(self, kind):
        node = self.tree.nodes.new(kind)
        node.hide = True
        node.location = (220 * self.column, -50 * self.row)
        self.row += 1
        return node

    def _next_column(self):
        self.column += 1
        self.row = 0

    def _set(self, socket, value):
        """Links an output socket, or sets a constant."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def _math(self, operation, *values):
        node = self._node("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values):
            self._set(socket, value)
        return node.outputs[0]

    def _vector(self, operation, *values):
        node = self._node("ShaderNodeVectorMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values):
            self._set(socket, value)
        return node.outputs[0]

    def _scaled(self, vector, factor):
        node = self._node("ShaderNodeVectorMath")
        node.operation = "SCALE"
        self._set(node.inputs[0], vector)
        self._set(node.inputs["Scale"], factor)
        return node.outputs[0]

    def _image(self, file, is_colour=False, uv=None):
        """An image texture. Alpha is a channel of its own, so that it does not change the colours."""
        path = os.path.join(self.folder, file)
        image = bpy.data.images.load(path, check_existing=True)
        image.reload()  # the export may be newer than what Blender has in memory
        image.colorspace_settings.name = "sRGB" if is_colour else "Non-Color"
        image.alpha_mode = "CHANNEL_PACKED"
        node = self._node("ShaderNodeTexImage")
        node.image = image
        self.tree.links.new(uv or self.uv.outputs[0], node.inputs["Vector"])
        return node

    def _base_uv(self, entry):
        """UVs of the material's own textures. glTF counts v from the top, Blender from the bottom."""
        scale, offset = entry["texture_scale"], entry["texture_offset"]
        if scale == [1, 1] and offset == [0, 0]:
            return self.uv.outputs[0]
        return self._vector("MULTIPLY_ADD", self.uv.outputs[0], (scale[0], scale[1], 1.0),
                            (offset[0], 1.0 - scale[1] - offset[1], 0.0))

    def _slope(self, file, uv=None):
        """n.xy / n.z of a normal map; the third component is 0."""
        texture = self._image(file, uv=uv)
        normal = self._vector("MULTIPLY_ADD", texture.outputs["Color"], (2.0, 2.0, 2.0), (-1.0, -1.0, -1.0))
        split = self._node("ShaderNodeSeparateXYZ")
        self._set(split.inputs[0], normal)
        z = self._math("MAXIMUM", split.outputs[2], 0.001)
        slope = self._vector("MULTIPLY", self._scaled(normal, self._math("DIVIDE", 1.0, z)), (1.0, 1.0, 0.0))
        return self._vector("MINIMUM", self._vector("MAXIMUM", slope, (-16.0,) * 3), (16.0,) * 3)

    def _masks(self, wrinkles, entry):
        """(mask, channel) -> socket."""
        sockets = {}
        for index in entry["masks"]:
            texture = self._image(wrinkles["masks"][index]["file"])
            split = self._node("ShaderNodeSeparateXYZ")
            self._set(split.inputs[0], texture.outputs["Color"])
            for channel, socket in zip("rgb", split.outputs):
                sockets[index, channel] = socket
            sockets[index, "a"] = texture.outputs["Alpha"]
        return sockets

    def _coefficient(self, map_index, weights, masks):
        """The sum of weight * mask over the regions of a map; the part of masks by skin weights is at most 1."""
        painted = self._sum(map_index, [w for w in weights if not w["skinned"]], masks)
        skinned = self._sum(map_index, [w for w in weights if w["skinned"]], masks)
        if skinned is None:
            return painted
        limited = self._math("MINIMUM", skinned, 1.0)
        return limited if painted is None else self._math("ADD", painted, limited)

    def _sum(self, map_index, weights, masks):
        channels = {}  # of weights of one map in one channel, the largest counts
        for weight in weights:
            if weight["map"] == map_index:
                value = self.input.outputs[weight["name"]]
                place = weight["mask"], weight["channel"]
                channels[place] = self._math("MAXIMUM", channels[place], value) if place in channels else value
        total = None
        for place, value in channels.items():
            if total is None:
                total = self._math("MULTIPLY", value, masks[place])
            else:
                total = self._math("MULTIPLY_ADD", value, masks[place], total)
        return total

    def _factor(self, so_far, texel, coefficient):
        """so_far * max(mix(1, texel, coefficient), 0)."""
        change = self._scaled(self._vector("SUBTRACT", texel, (1.0,) * 3), coefficient)
        factor = self._vector("MAXIMUM", self._vector("ADD", change, (1.0,) * 3), (0.0,) * 3)
        return factor if so_far is None else self._vector("MULTIPLY", so_far, factor)

    def _build(self, wrinkles, entry, weights):
        self._next_column()
        masks = self._masks(wrinkles, entry)
        self._next_column()
        slope = None
        if entry["base_normal"]:
            slope = self._slope(entry["base_normal"], self._base_uv(entry))
        colour = cavity = None
        for index in entry["maps"]:
            self._next_column()
            of = wrinkles["maps"][index]
            coefficient = self._coefficient(index, weights, masks)
            if of["normal"]:
                part = self._scaled(self._slope(of["normal"]), self._math("MULTIPLY", coefficient, of["strength"]))
                slope = part if slope is None else self._vector("ADD", slope, part)
            if of["colour"]:
                texel = self._scaled(self._image(of["colour"], is_colour=True).outputs["Color"], of["colour_scale"])
                colour = self._factor(colour, texel, coefficient)
            if of["cavity"]:
                cavity = self._factor(cavity, self._image(of["cavity"]).outputs["Color"], coefficient)
        self._finish(slope, colour, cavity)

    def _finish(self, slope, colour, cavity):
        self._next_column()
        flat = self._vector("ADD", slope if slope is not None else (0.0,) * 3, (0.0, 0.0, 1.0))
        unit = self._vector("NORMALIZE", flat)
        normal_map = self._node("ShaderNodeNormalMap")
        self._set(normal_map.inputs["Color"], self._vector("MULTIPLY_ADD", unit, (0.5,) * 3, (0.5,) * 3))
        output = self._node("NodeGroupOutput")
        self._set(output.inputs["Normal"], normal_map.outputs[0])
        self._set(output.inputs["Colour"], colour if colour is not None else (1.0,) * 4)
        if cavity is None:
            output.inputs["Cavity"].default_value = 1.0
        else:
            split = self._node("ShaderNodeSeparateXYZ")
            self._set(split.inputs[0], cavity)
            self._set(output.inputs["Cavity"], split.outputs[0])
