# SPDX-License-Identifier: Apache-2.0
# Prints a line per frame that the Godot 3 add-on receives. Arguments: HOST:PORT of the daemon's HTTP server, and the
# subject.
extends SceneTree

const CLIENT = preload("res://addons/furrow/furrow_client.gd")

var client = CLIENT.new()


func _init():
	var arguments = OS.get_cmdline_args()
	var count = arguments.size()
	ProjectSettings.set_setting("furrow/network/address", arguments[count - 2])
	client.subjects = PoolStringArray([arguments[count - 1]])
	client.connect("weights_changed", self, "_on_weights")
	root.add_child(client)


func _on_weights(subject, _names, _values):
	# Weights that are held or decay are not news.
	if client.get_age_msec(subject) < 100:
		print("weights")
