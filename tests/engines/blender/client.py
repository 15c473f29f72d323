# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender: installs the add-on as users do, follows two subjects on two objects, records and clears."""
import json
import re
import sys
import time

import bpy

ADDRESS, LIBRARY, FRAMES = sys.argv[-3], sys.argv[-2], int(sys.argv[-1])
SUBJECTS = ("ada", "bob")
WEIGHT = "brow_l.squash"


def tell(event, **what):
    print("furrow-test: " + json.dumps({"event": event, **what}), flush=True)


def cube_with_keys(name):
    """A cube with a shape key of a weight, and a material that reads another weight."""
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    cube.name = name
    cube.shape_key_add(name="Basis")
    cube.shape_key_add(name=WEIGHT).data[0].co.z += 1
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeAttribute")
    node.attribute_type, node.attribute_name = "OBJECT", "furrow_brow_r_squash"
    cube.data.materials.append(material)
    # As a rig would: a driver reads a third weight.
    driver = cube.driver_add("location", 0).driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = cube, '["furrow_nose_squash"]'
    return cube


def poll():
    session.poll(bpy.context.scene)
    time.sleep(0.002)


bpy.ops.preferences.addon_enable(module="furrow")
from furrow import library  # pylint: disable=wrong-import-position
from furrow.session import session, tick  # pylint: disable=wrong-import-position

bpy.context.preferences.addons["furrow"].preferences.library_path = LIBRARY
settings = bpy.context.scene.furrow
settings.address = ADDRESS
cubes = {}
for subject in SUBJECTS:
    cubes[subject] = cube_with_keys(subject)
    bpy.ops.furrow.add()
    settings.rows[-1].subject = subject
    assert settings.rows[-1].target == cubes[subject], "the active object"

runs, longest, last = dict.fromkeys(SUBJECTS, 0), dict.fromkeys(SUBJECTS, 0), {}
seen = {subject: [1.0, 0.0] for subject in SUBJECTS}  # lowest and highest value on the object


def count(frame):
    assert frame.timecode == "", "BVH has no timecode"
    following = last.get(frame.subject, frame.sequence - 1) + 1 == frame.sequence
    runs[frame.subject] = runs[frame.subject] + 1 if following and not frame.decaying else 1
    longest[frame.subject] = max(longest[frame.subject], runs[frame.subject])
    last[frame.subject] = frame.sequence


# Scripts read the timecode of a face tracker.
phone = library.Connection(library.load(LIBRARY), ADDRESS)
phone.subscribe("cam")
arrived = []
while not arrived:
    arrived = phone.poll()
    time.sleep(0.002)
phone.close()
assert re.fullmatch("10:00:00:[0-5][0-9]", arrived[0].timecode), arrived[0].timecode
session.on_frame = count
assert bpy.ops.furrow.connect() == {"FINISHED"}
while not all(cube.get("furrow_brow_l_squash") for cube in cubes.values()):
    poll()
bpy.ops.furrow.record()
runs, longest = dict.fromkeys(SUBJECTS, 0), dict.fromkeys(SUBJECTS, 0)
moved = 0.0
while min(longest.values()) < FRAMES:
    poll()
    for subject, cube in cubes.items():
        value = cube["furrow_brow_l_squash"]
        assert cube.data.shape_keys.key_blocks[WEIGHT].value == value, "property and shape key agree"
        bpy.context.view_layer.update()
        location = cube.evaluated_get(bpy.context.evaluated_depsgraph_get()).location[0]
        assert abs(location - cube["furrow_nose_squash"]) < 1e-6, "drivers follow"
        moved = max(moved, location)
        seen[subject] = [min(seen[subject][0], value), max(seen[subject][1], value)]
tell("received", runs=longest, seen=seen, moved=moved, status=[session.row_status(row) for row in settings.rows])

# Keyframes: one per frame and weight, on properties and shape keys alike, with the values that were live.
bpy.ops.furrow.record()
channels = {}
for subject, cube in cubes.items():
    curve = cube.animation_data.action.fcurves.find('["furrow_brow_l_squash"]')
    key = cube.data.shape_keys.animation_data.action.fcurves.find(f'key_blocks["{WEIGHT}"].value')
    points = [point.co[:] for point in curve.keyframe_points]
    assert len(points) >= FRAMES and [p.co[:] for p in key.keyframe_points] == points
    assert {point.interpolation for point in curve.keyframe_points} == {"LINEAR"}
    assert points[0][0] == bpy.context.scene.frame_start
    assert all(a[0] < b[0] for a, b in zip(points, points[1:])), "times ascend"
    channels[subject] = {"points": len(points), "span": points[-1][0] - points[0][0],
                         "values": [min(p[1] for p in points), max(p[1] for p in points)]}
tell("recorded", channels=channels, frame_end=bpy.context.scene.frame_end)
cubes["ada"].animation_data.action.fcurves.new("location", index=0)  # an animator's own channel stays
bpy.ops.furrow.clear()
assert [curve.data_path for curve in cubes["ada"].animation_data.action.fcurves] == ["location"]
assert cubes["bob"].animation_data.action is None
assert cubes["bob"].data.shape_keys.animation_data.action is None

while session.connected:
    poll()
tell("lost", status=session.status())
before = dict(session.bindings.items())
frames = {subject: binding.frames for subject, binding in before.items()}
while any(binding.frames == frames[subject] for subject, binding in session.bindings.items()) or any(
        binding.state.decaying for binding in session.bindings.values()):
    poll()
tell("again", status=session.status())

# Subjects and the connection change at run time.
settings.active = 1
bpy.ops.furrow.remove()
assert not any(name.startswith("furrow_") for name in cubes["bob"].keys()), "the properties left with the row"
poll()
assert list(session.bindings) == ["ada"]
bpy.ops.furrow.disconnect()
assert session.poll(bpy.context.scene) == 0 and session.status() == "not connected"
settings.address = "http://127.0.0.1"
try:
    bpy.ops.furrow.connect()
    raise AssertionError("an invalid address is an error")
except RuntimeError as error:
    assert "furrow://" in str(error) and session.status() in str(error)
settings.address = ADDRESS
bpy.ops.furrow.connect()
while "ada" not in session.bindings or session.bindings["ada"].frames == 0:
    assert tick() < 0.1, "the window's timer polls often while connected"
    time.sleep(0.002)
try:
    bpy.ops.furrow.build_material(filepath="/absent.json")
    raise AssertionError("a file that is absent is an error")
except RuntimeError as error:
    assert "/absent.json" in str(error) or "no nodes.py" in str(error), str(error)
bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
assert session.connection is None, "loading a file disconnects"
assert tick() >= 0.5
bpy.ops.preferences.addon_disable(module="furrow")
tell("end")
