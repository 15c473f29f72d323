# SPDX-License-Identifier: Apache-2.0
"""Where weights go on an object: custom properties, shape keys, and the attributes that its materials read."""
import re

PREFIX = "furrow_"
# Blender cuts names of properties at 63 bytes.
_MAX_PROPERTY = 63


def property_name(weight):
    """The custom property of a weight: "brow_l.squash" becomes "furrow_brow_l_squash"."""
    return (PREFIX + re.sub(r"[^A-Za-z0-9]", "_", weight))[:_MAX_PROPERTY]


def _shape_keys(target):
    keys = getattr(target.data, "shape_keys", None)
    return keys.key_blocks if keys else {}


def _attributes(tree, seen):
    """The names of all attributes that a node tree reads, groups included."""
    if tree is None or tree.name_full in seen:
        return
    seen.add(tree.name_full)
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeAttribute":
            yield node.attribute_name
        elif node.bl_idname == "ShaderNodeGroup":
            yield from _attributes(node.node_tree, seen)


class Targets:
    """The weights of one layout on one object. Make a new one when the names or the object change."""

    def __init__(self, target, names):
        self.names = names
        self.properties = [property_name(name) for name in names]
        self.create(target)

    def create(self, target):
        """Creates the custom properties, so that drivers and materials find them before the first frame."""
        missing = [name for name in self.properties if name not in target]
        for name in missing:
            target[name] = 0.0
            target.id_properties_ui(name).update(min=0.0, max=1.0, soft_min=0.0, soft_max=1.0)
        if missing:
            # Blender gives up on a driver whose property was missing. A new path makes it try again.
            for source, _ in _driver_sources(target):
                source.data_path = source.data_path

    def apply(self, target, values):
        """Writes a frame to the object and tags it for an update."""
        keys = _shape_keys(target)
        for name, prop, value in zip(self.names, self.properties, values):
            target[prop] = value
            for key in (prop, name):
                if key in keys:
                    keys[key].value = value
        target.update_tag()  # without arguments: drivers run again, too

    def covered(self, target):
        """How many weights something reads: a shape key, a driver, or an Attribute node of a material."""
        read = set(_shape_keys(target).keys())
        for slot in target.material_slots:
            if slot.material and slot.material.use_nodes:
                read.update(name.strip('[]"\'') for name in _attributes(slot.material.node_tree, set()))
        used = {prop for _, prop in _driver_sources(target)}
        return sum(prop in read or name in read or prop in used for name, prop in zip(self.names, self.properties))


def _driver_sources(target):
    """Yields the targets of driver variables that read furrow_ properties of the object, with the property's name. Looks
    at drivers of the object, its data and its materials."""
    owners = [target, target.data, getattr(target.data, "shape_keys", None)]
    owners += [slot.material.node_tree for slot in target.material_slots if slot.material and slot.material.use_nodes]
    for owner in owners:
        animation = getattr(owner, "animation_data", None)
        for curve in animation.drivers if animation else ():
            for variable in curve.driver.variables:
                for source in variable.targets:
                    found = re.search(rf'\["({PREFIX}\w+)"\]', source.data_path)
                    if found and source.id == target:
                        yield source, found[1]


def remove(target):
    """Removes the custom properties of this add-on from an object."""
    for name in [name for name in target.keys() if name.startswith(PREFIX)]:
        del target[name]
