# SPDX-License-Identifier: Apache-2.0
# Puts the weights of one subject on every mesh at or below a node: on blend shapes named like the weight
# ("brow_l.squash") or its property ("furrow_brow_l_squash"), and on shader materials with a uniform float of the
# property's name, as exported wrinkle materials have.
#
# Each weight is also a property of this node, furrow_brow_l_squash, so that animations can play what FurrowRecorder
# recorded.
extends Node

export(NodePath) var client
export(NodePath) var mesh
# The subject whose weights to apply. Empty: the first to come.
export var subject = ""
# The names of the weights. The client sets them; they are saved with the scene, so that animations play without it.
export(PoolStringArray) var names = PoolStringArray() setget set_names

var values = PoolRealArray()
# Further objects with a method set_weights(names, values). Arrays with one entry per weight.
var receivers = []

var _index = {}  # property -> index
var _uses = {}  # index -> [[mesh or material, property], ...]
var _changed = false


static func property_name(weight):
	var text = "furrow_"
	for c in weight:
		var is_plain = (c >= "a" and c <= "z") or (c >= "A" and c <= "Z") or (c >= "0" and c <= "9")
		text += c if is_plain else "_"
	return text


func _ready():
	if has_node(client):
		get_node(client).connect("weights_changed", self, "_on_weights_changed")
	find_uses()


func _process(_delta):
	apply()


func set_names(to):
	names = to
	_index = {}
	for i in names.size():
		_index[property_name(names[i])] = i
	values = PoolRealArray()
	values.resize(names.size())
	for i in names.size():
		values[i] = 0.0
	find_uses()
	property_list_changed_notify()


# Writes the newest values to the meshes; _process() does so once per picture.
func apply():
	if not _changed:
		return
	_changed = false
	for i in _uses:
		for use in _uses[i]:
			if not is_instance_valid(use[0]):
				continue
			if use[0] is ShaderMaterial:
				use[0].set_shader_param(use[1], values[i])
			else:
				use[0].set(use[1], values[i])
	for receiver in receivers:
		receiver.set_weights(Array(names), Array(values))


# How many names a blend shape or a material uses.
func covered():
	return _uses.size()


# Looks for blend shapes and materials again. Call it after meshes or materials below the node have changed.
func find_uses():
	_uses = {}
	var top = get_node_or_null(mesh) if is_inside_tree() else null
	if top != null:
		_find_uses_below(top)


func _on_weights_changed(from, new_names, new_values):
	if subject == "":
		subject = from
	if from != subject:
		return
	if new_names != names:
		set_names(new_names)
	values = new_values
	_changed = true


func _find_uses_below(node):
	if node is MeshInstance:
		for property in node.get_property_list():
			if property.name.begins_with("blend_shapes/"):
				var shape = property.name.trim_prefix("blend_shapes/")
				# Importers replace characters, so the rule for properties applies to the shape's name, too.
				_add_use(shape if _index.has(shape) else property_name(shape), node, property.name)
		for material in _materials(node):
			if material is ShaderMaterial and material.shader != null:
				for uniform in _uniforms(material.shader):
					_add_use(uniform, material, uniform)
	for child in node.get_children():
		_find_uses_below(child)


func _add_use(property, object, path):
	if not _index.has(property):
		return
	var i = _index[property]
	if not _uses.has(i):
		_uses[i] = []
	_uses[i].append([object, path])


# The uniforms of weights. Read from the text: a server without a display does not parse shaders.
func _uniforms(shader):
	var expression = RegEx.new()
	expression.compile("uniform\\s+(?:(?:lowp|mediump|highp)\\s+)?float\\s+(furrow_\\w+)")
	var found = []
	for result in expression.search_all(shader.code):
		found.append(result.get_string(1))
	return found


func _materials(instance):
	var found = []
	if instance.material_override != null:
		found.append(instance.material_override)
	for i in instance.get_surface_material_count():
		var material = instance.get_surface_material(i)
		if material == null and instance.mesh != null:
			material = instance.mesh.surface_get_material(i)
		if material != null:
			found.append(material)
	return found


func _get_property_list():
	var list = []
	for property in _index:
		list.append({"name": property, "type": TYPE_REAL, "hint": PROPERTY_HINT_RANGE, "hint_string": "0,1",
				"usage": PROPERTY_USAGE_EDITOR})
	return list


func _get(property):
	return values[_index[property]] if _index.has(property) else null


func _set(property, value):
	if not _index.has(property):
		return false
	values[_index[property]] = clamp(value, 0.0, 1.0)
	_changed = true
	return true
