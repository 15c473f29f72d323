# SPDX-License-Identifier: Apache-2.0
# Runs in godot3-server: two subjects on two meshes, a recording, and a restart of the daemon. Arguments: HOST:PORT of the
# daemon's HTTP server, and the number of frames to receive.
extends SceneTree

const CLIENT = preload("res://addons/furrow/furrow_client.gd")
const TARGET = preload("res://addons/furrow/furrow_target.gd")
const RECORDER = preload("res://addons/furrow/furrow_recorder.gd")
const PANEL = preload("res://addons/furrow/furrow_panel.gd")
const SUBJECTS = ["ada", "bob"]

var client = CLIENT.new()
var targets = {}
var recorder = RECORDER.new()
var player = AnimationPlayer.new()
var panel = PANEL.new()
var needed = 0
var stage = "receive"
var runs = {}
var longest = {}
var last = {}
var frames_before = {}
var shape_seen = 0.0
var receiver = Receiver.new()


# Like furrow_material.gd: an object that takes weights.
class Receiver:
	var seen = 0

	func set_weights(names: Array, values: Array) -> void:
		assert(names.size() == values.size())
		seen += 1


func tell(event, more = {}):
	more["event"] = event
	print("furrow-test: " + JSON.print(more))


func check(condition, what):
	if not condition:
		print("FAILED: " + what)
		OS.exit_code = 1
		quit(1)


func _init():
	var arguments = OS.get_cmdline_args()
	needed = int(arguments[arguments.size() - 1])
	ProjectSettings.set_setting("furrow/network/address", arguments[arguments.size() - 2])
	client.name = "Client"
	client.subjects = PoolStringArray(SUBJECTS)
	check(client.connect("weights_changed", self, "_on_weights") == OK, "signal")
	root.add_child(client)
	for subject in SUBJECTS:
		var mesh = mesh_with_shape()
		mesh.name = subject
		root.add_child(mesh)
		var target = TARGET.new()
		target.name = "Target_" + subject
		target.client = NodePath("../Client")
		target.mesh = NodePath("../" + subject)
		target.subject = subject
		root.add_child(target)
		target.receivers.append(receiver)
		targets[subject] = target
		runs[subject] = 0
		longest[subject] = 0
	player.name = "Player"
	root.add_child(player)
	recorder.client = NodePath("../Client")
	recorder.target = NodePath("../Target_ada")
	recorder.player = NodePath("../Player")
	recorder.name = "Recorder"
	root.add_child(recorder)
	panel.client = NodePath("../Client")
	panel.target = NodePath("../Target_ada")
	panel.recorder = NodePath("../Recorder")
	root.add_child(panel)


func mesh_with_shape():
	var arrays = []
	arrays.resize(ArrayMesh.ARRAY_MAX)
	arrays[ArrayMesh.ARRAY_VERTEX] = PoolVector3Array([Vector3(), Vector3(1, 0, 0), Vector3(0, 1, 0)])
	var mesh = ArrayMesh.new()
	mesh.add_blend_shape("brow_l_squash")  # as an importer writes brow_l.squash
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [[arrays[ArrayMesh.ARRAY_VERTEX]]])
	var instance = MeshInstance.new()
	instance.mesh = mesh
	return instance


func _on_weights(subject, names, values):
	var stream = client.get_stream(subject)
	check(names.size() == values.size() and names.size() > 50, "names and values")
	var follows = not last.has(subject) or stream.sequence == last[subject] + 1
	last[subject] = stream.sequence
	runs[subject] = runs[subject] + 1 if follows and stream.age_ms == 0.0 else 1
	longest[subject] = max(longest[subject], runs[subject])


func shape_value(subject):
	return root.get_node(subject).get("blend_shapes/brow_l_squash")


func _idle(_delta):
	if stage == "receive" and shape_value("ada") > 0.0 and shape_value("bob") > 0.0:
		panel.get_child(0).get_child(3).emit_signal("pressed")  # the button Record
		check(recorder.recording, "the button starts the recording")
		for subject in SUBJECTS:
			longest[subject] = 0
			runs[subject] = 0
		stage = "record"
	elif stage == "record":
		shape_seen = max(shape_seen, shape_value("ada"))
		if min(longest.ada, longest.bob) >= needed:
			after_recording()
			stage = "wait for loss"
	elif stage == "wait for loss" and client.state == CLIENT.State.LOST:
		tell("lost", {"status": client.get_status()})
		for subject in SUBJECTS:
			frames_before[subject] = client.get_stream(subject).frames
		stage = "wait for return"
	elif stage == "wait for return" and is_back("ada") and is_back("bob"):
		tell("again", {"status": client.get_status()})
		client.close()
		client.poll()
		check(client.get_status() == "not connected", "close")
		client.subjects = PoolStringArray(["bob"])
		runs.bob = 0
		client.open()
		stage = "open again"
	elif stage == "open again" and runs.bob > 0:
		check(runs.bob > 0, "connects again at run time")
		client.close()
		stage = "done"
		tell("end")
		quit()
	return false


func is_back(subject):
	var stream = client.get_stream(subject)
	return stream.frames > frames_before[subject] and stream.age_ms == 0.0


func after_recording():
	tell("received", {"runs": longest, "shape": shape_seen,
			"status": panel.get_child(0).get_child(1).text, "receiver": receiver.seen})
	panel.get_child(0).get_child(3).emit_signal("pressed")
	var animation = player.get_animation("furrow")
	var names = client.get_stream("ada").names
	check(animation.get_track_count() == names.size(), "one track per weight")
	var track = animation.find_track(NodePath("Target_ada:furrow_brow_l_squash"))
	check(track >= 0, "the track of brow_l.squash")
	var keys = animation.track_get_key_count(track)
	var highest = 0
	for i in keys:
		if animation.track_get_key_value(track, i) > animation.track_get_key_value(track, highest):
			highest = i
	# Played without the client, the animation moves the mesh as the performer did.
	client.set_process(false)
	player.play("furrow")
	player.seek(animation.track_get_key_time(track, highest), true)
	targets.ada.apply()
	tell("recorded", {"keys": keys, "length": animation.length, "played": shape_value("ada"),
			"recorded": animation.track_get_key_value(track, highest)})
	player.stop()
	client.set_process(true)
	panel.get_child(0).get_child(4).emit_signal("pressed")  # the button Clear
	check(not player.has_animation("furrow"), "the button removes the animation")
