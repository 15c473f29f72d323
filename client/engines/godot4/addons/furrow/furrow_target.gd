# SPDX-License-Identifier: Apache-2.0
# NOT RUN: a port of the add-on for Godot 3. Puts the weights of one subject on every mesh at or below a node: on blend
# shapes named like the weight ("brow_l.squash") or its property ("furrow_brow_l_squash"), and on shader materials with a
# uniform of the property's name.
extends Node

@export var client: NodePath
@export var mesh: NodePath
# The subject whose weights to apply. Empty: the first to come.
@export var subject := ""

var names := PackedStringArray()
var values := PackedFloat32Array()
# Further objects with a method set_weights(names, values).
var receivers := []

var _uses := {}  # index -> [[mesh or material, property], ...]
var _changed := false


static func property_name(weight: String) -> String:
	var text := "furrow_"
	for c in weight:
		var is_plain := (c >= "a" and c <= "z") or (c >= "A" and c <= "Z") or (c >= "0" and c <= "9")
		text += c if is_plain else "_"
	return text


func _ready() -> void:
	var source := get_node_or_null(client)
	if source != null:
		source.weights_changed.connect(_on_weights_changed)


func _process(_delta: float) -> void:
	apply()


# Writes the newest values to the meshes, once per picture.
func apply() -> void:
	if not _changed:
		return
	_changed = false
	for i in _uses:
		for use in _uses[i]:
			if not is_instance_valid(use[0]):
				continue
			if use[0] is ShaderMaterial:
				use[0].set_shader_parameter(use[1], values[i])
			else:
				use[0].set(use[1], values[i])
	for receiver in receivers:
		receiver.set_weights(Array(names), Array(values))


# How many names a blend shape or a material uses.
func covered() -> int:
	return _uses.size()


# Looks for blend shapes and materials again, after meshes or materials below the node have changed.
func find_uses() -> void:
	_uses = {}
	var top := get_node_or_null(mesh)
	if top != null:
		_find_uses_below(top)


func _on_weights_changed(from: String, new_names: PackedStringArray, new_values: PackedFloat32Array) -> void:
	if subject == "":
		subject = from
	if from != subject:
		return
	if new_names != names:
		names = new_names
		find_uses()
	values = new_values
	_changed = true


func _find_uses_below(node: Node) -> void:
	if node is MeshInstance3D:
		for property in node.get_property_list():
			if property.name.begins_with("blend_shapes/"):
				_add_use(property.name.trim_prefix("blend_shapes/"), node, property.name)
		for material in _materials(node):
			if material is ShaderMaterial and material.shader != null:
				for uniform in material.shader.get_shader_uniform_list():
					_add_use(uniform.name, material, uniform.name)
	for child in node.get_children():
		_find_uses_below(child)


func _add_use(found: String, object: Object, path: String) -> void:
	for i in names.size():
		# Importers replace characters, so the rule for properties applies to both sides.
		if found == property_name(names[i]) or property_name(found) == property_name(names[i]):
			if not _uses.has(i):
				_uses[i] = []
			_uses[i].append([object, path])


func _materials(instance: MeshInstance3D) -> Array:
	var found := []
	if instance.mesh != null:
		for i in instance.mesh.get_surface_count():
			found.append(instance.get_active_material(i))
	return found
