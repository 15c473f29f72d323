# SPDX-License-Identifier: Apache-2.0
# Adds the nodes of Furrow to the dialog "Create New Node", and its settings to the project (Furrow > Network).
tool
extends EditorPlugin

const SETTINGS = preload("furrow_settings.gd")
const NODES = {
	"FurrowClient": ["Node", preload("furrow_client.gd")],
	"FurrowTarget": ["Node", preload("furrow_target.gd")],
	"FurrowRecorder": ["Node", preload("furrow_recorder.gd")],
	"FurrowPanel": ["PanelContainer", preload("furrow_panel.gd")],
}


func _enter_tree():
	SETTINGS.add_to_project()
	for name in NODES:
		add_custom_type(name, NODES[name][0], NODES[name][1], null)


func _exit_tree():
	for name in NODES:
		remove_custom_type(name)
