# SPDX-License-Identifier: Apache-2.0
"""Runs in Blender: draws the normals of a character as seen, once for each set of weights.

blender -b --factory-startup --python blender_normals.py -- JOB.json; the job names the files (test_parity.py).
"""
import json
import math
import sys

import bpy
import numpy
from mathutils import Vector

# The glTF importer of Blender 3.4.1 uses a name that Debian's numpy 1.24 has removed.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

job = json.load(open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8"))
sys.path.insert(0, job["nodes"])
import nodes  # noqa: E402


def to_blender(v):
    """glTF has y up, Blender z."""
    return Vector((v[0], -v[2], v[1]))


def add_camera(preset, size):
    camera = bpy.data.cameras.new("camera")
    camera.angle = math.radians(preset["fov_y_degrees"])  # the picture is a square
    camera.clip_start = 0.01
    obj = bpy.data.objects.new("camera", camera)
    obj.location = to_blender(preset["position"])
    obj.rotation_euler = (to_blender(preset["target"]) - obj.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(obj)
    scene = bpy.context.scene
    scene.camera = obj
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100


def emit_normal(material, group_name):
    """Shows the shading normal in the axes of glTF as n * 0.5 + 0.5, without light."""
    tree = material.node_tree
    group = tree.nodes[group_name]
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(group.outputs["Normal"], split.inputs[0])
    join = tree.nodes.new("ShaderNodeCombineXYZ")
    for to, (source, sign) in enumerate(((0, 0.5), (2, 0.5), (1, -0.5))):
        scale = tree.nodes.new("ShaderNodeMath")
        scale.operation = "MULTIPLY_ADD"
        scale.inputs[1].default_value = sign
        scale.inputs[2].default_value = 0.5
        tree.links.new(split.outputs[source], scale.inputs[0])
        tree.links.new(scale.outputs[0], join.inputs[to])
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(join.outputs[0], emission.inputs["Color"])
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])


def set_engine(name, samples):
    scene = bpy.context.scene
    scene.render.engine = name
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filter_size = 0.01 if samples == 1 else 1.0
    scene.render.dither_intensity = 0.0
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01 if samples == 1 else 1.0
    scene.eevee.taa_render_samples = samples


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=job["glb"])
built = []
for obj in list(bpy.context.scene.objects):
    if obj.type != "MESH":
        continue
    try:
        count = {name: len(m.node_tree.nodes) for name, m in nodes.build_material(job["wrinkles"], obj).items()}
        materials = nodes.build_material(job["wrinkles"], obj)  # the second call replaces the nodes of the first
        assert count == {name: len(m.node_tree.nodes) for name, m in materials.items()}, count
    except ValueError:
        materials = {}
    if not set(materials) & set(job["materials"]):
        obj.hide_render = True
        continue
    built.append(obj)
    for name, material in materials.items():
        emit_normal(material, nodes.GROUP_PREFIX + name)
add_camera(job["camera"], job["size"])
for picture in job["pictures"]:
    for obj in built:
        every = [k[len("furrow_"):] for k in obj.keys() if k.startswith("furrow_")]
        nodes.set_weights(obj, every, [0.0] * len(every))
        nodes.set_weights(obj, list(picture["weights"]), list(picture["weights"].values()))
    bpy.context.view_layer.update()
    set_engine(picture["engine"], picture["samples"])
    bpy.context.scene.render.filepath = picture["file"]
    bpy.ops.render.render(write_still=True)
