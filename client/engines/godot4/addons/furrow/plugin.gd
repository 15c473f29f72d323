# SPDX-License-Identifier: Apache-2.0
# NOT RUN: a port of the add-on for Godot 3. Adds the nodes, and the setting furrow/network/address.
@tool
extends EditorPlugin

const NODES := {
	"FurrowClient": preload("furrow_client.gd"),
	"FurrowTarget": preload("furrow_target.gd"),
}


func _enter_tree() -> void:
	if not ProjectSettings.has_setting("furrow/network/address"):
		ProjectSettings.set_setting("furrow/network/address", "127.0.0.1:7480")
	ProjectSettings.set_initial_value("furrow/network/address", "127.0.0.1:7480")
	for type_name in NODES:
		add_custom_type(type_name, "Node", NODES[type_name], null)


func _exit_tree() -> void:
	for type_name in NODES:
		remove_custom_type(type_name)
