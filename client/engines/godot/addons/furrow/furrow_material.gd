# SPDX-License-Identifier: Apache-2.0
# The wrinkle materials of an export (`furrow export --for godot`), for Godot 3.
#
#     var wrinkles = preload("res://addons/furrow/furrow_material.gd").new()
#     if wrinkles.open("res://face/wrinkles.json") == OK:
#         wrinkles.apply($Character)                       # every mesh below the node
#         wrinkles.set_weights(["brow_l.squash"], [1.0])
#
# Each wrinkle weight is a shader parameter: "furrow_" and the weight's name, with every character that
# is no ASCII letter or digit replaced by "_".
extends Reference

const FORMAT := "furrow-wrinkles"
const VERSION := 1

# What went wrong in open(), in one sentence.
var message := ""
# The content of wrinkles.json.
var wrinkles := {}

var _folder := ""
var _materials := {}  # by the name of the entry in wrinkles.json
var _parameters := {}  # weight's name -> [shader parameter, materials that have it]


# Reads wrinkles.json and builds its materials. Returns OK, or an error that `message` explains.
func open(path: String) -> int:
	wrinkles = {}
	_materials = {}
	_parameters = {}
	_folder = path.get_base_dir()
	var file := File.new()
	var error := file.open(path, File.READ)
	if error != OK:
		return _fail(error, path + ": cannot be read")
	var parsed := JSON.parse(file.get_as_text())
	file.close()
	if parsed.error != OK:
		return _fail(ERR_PARSE_ERROR, "%s:%d: %s" % [path, parsed.error_line, parsed.error_string])
	if typeof(parsed.result) != TYPE_DICTIONARY or parsed.result.get("format") != FORMAT:
		return _fail(ERR_FILE_UNRECOGNIZED, path + ": not a wrinkles.json; write one with 'furrow export --for godot'")
	if int(parsed.result.get("version", 0)) != VERSION:
		return _fail(ERR_FILE_UNRECOGNIZED, path + ": another version; update this add-on")
	if parsed.result.get("engine") != "godot":
		return _fail(ERR_FILE_UNRECOGNIZED, path + ": made for another engine; export with --for godot")
	wrinkles = parsed.result
	for entry in wrinkles.materials:
		error = _build(entry)
		if error != OK:
			return error
	message = ""
	return OK


# The names of the materials in wrinkles.json.
func names() -> Array:
	return _materials.keys()


# The material of an entry, or null.
func material(name: String) -> ShaderMaterial:
	return _materials.get(name)


# Replaces the materials below `node` that have the name of an entry. Returns how many surfaces changed.
func apply(node: Node) -> int:
	var count := 0
	if node is MeshInstance and node.mesh != null:
		for surface in node.mesh.get_surface_count():
			var old = node.get_surface_material(surface)
			if old == null:
				old = node.mesh.surface_get_material(surface)
			if old != null and _materials.has(old.resource_name):
				node.set_surface_material(surface, _materials[old.resource_name])
				count += 1
	for child in node.get_children():
		count += apply(child)
	return count


# Sets wrinkle weights by name. Names that no material has are ignored.
func set_weights(names: Array, values: Array) -> void:
	for i in min(names.size(), values.size()):
		var place = _parameters.get(names[i])
		if place == null:
			continue
		for of in place[1]:
			of.set_shader_param(place[0], float(values[i]))


func _fail(error: int, text: String) -> int:
	message = text
	return error


func _build(entry: Dictionary) -> int:
	var shader := _shader(entry.shader)
	if shader == null:
		return ERR_FILE_NOT_FOUND
	var built := ShaderMaterial.new()
	built.shader = shader
	built.resource_name = entry.name
	var factor: Array = entry.base_colour_factor
	built.set_shader_param("base_colour_factor", Color(factor[0], factor[1], factor[2], factor[3]))
	built.set_shader_param("roughness_factor", entry.roughness_factor)
	var textures := {
		"base_colour": entry.base_colour, "base_normal": entry.base_normal, "roughness_map": entry.roughness}
	for index in entry.maps:
		var map: Dictionary = wrinkles.maps[index]
		for part in ["normal", "colour", "cavity"]:
			textures["%s_%d" % [part, index]] = map[part]
	for index in entry.masks:
		textures["mask_%d" % index] = wrinkles.masks[index].file
	for parameter in textures:
		if textures[parameter] == null:
			continue
		var texture := _texture(textures[parameter])
		if texture == null:
			return ERR_FILE_NOT_FOUND
		built.set_shader_param(parameter, texture)
	for index in entry.weights:
		var weight: Dictionary = wrinkles.weights[index]
		if not _parameters.has(weight.name):
			_parameters[weight.name] = [weight.parameter, []]
		_parameters[weight.name][1].append(built)
		built.set_shader_param(weight.parameter, 0.0)
	_materials[entry.name] = built
	return OK


# Returns true and sets `message` if the name of a file leads out of the export's folder.
func _is_outside(name: String) -> bool:
	if not name.is_abs_path() and not ".." in name.replace("\\", "/").split("/"):
		return false
	message = _folder.plus_file(name) + ": lies outside the export's folder"
	return true


func _shader(name: String) -> Shader:
	if _is_outside(name):
		return null
	var path := _folder.plus_file(name)
	var file := File.new()
	if file.open(path, File.READ) != OK:
		message = path + ": cannot be read"
		return null
	var shader := Shader.new()
	shader.code = file.get_as_text()
	file.close()
	return shader


# An imported texture, or a picture file outside the project. Only the latter is read here, so that an
# exported game finds it, too.
func _texture(name: String) -> Texture:
	if _is_outside(name):
		return null
	var path := _folder.plus_file(name)
	if path.begins_with("res://") and ResourceLoader.exists(path):
		return load(path) as Texture
	var image := Image.new()
	if image.load(path) != OK:
		message = path + ": cannot be read"
		return null
	image.generate_mipmaps()
	var texture := ImageTexture.new()
	texture.create_from_image(image, Texture.FLAG_MIPMAPS | Texture.FLAG_FILTER | Texture.FLAG_REPEAT)
	return texture
