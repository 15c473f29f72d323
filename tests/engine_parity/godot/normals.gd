# SPDX-License-Identifier: Apache-2.0
# Draws the normals of a character as seen, once for each set of weights. The job names the files
# (test_parity.py): godot3-runner -s normals.gd JOB.json
extends SceneTree

var job := {}
var wrinkles
var view: Viewport


func _init():
	var file := File.new()
	if file.open(OS.get_cmdline_args()[-1], File.READ) != OK:
		printerr("no job")
		quit(1)
		return
	job = JSON.parse(file.get_as_text()).result
	file.close()
	call_deferred("_run")


func _run():
	wrinkles = load(job.script).new()
	if wrinkles.open(job.wrinkles) != OK:
		printerr(wrinkles.message)
		quit(1)
		return
	view = Viewport.new()
	view.size = Vector2(job.size, job.size)
	view.own_world = true
	view.render_target_update_mode = Viewport.UPDATE_ALWAYS
	view.render_target_v_flip = true
	get_root().add_child(view)
	_add_camera()
	var light := DirectionalLight.new()
	view.add_child(light)
	for mesh in job.meshes:
		_add_mesh(mesh)
	for picture in job.pictures:
		for weight in wrinkles.wrinkles.weights:
			wrinkles.set_weights([weight.name], [0.0])
		wrinkles.set_weights(picture.weights.keys(), picture.weights.values())
		for _i in 3:
			yield(self, "idle_frame")
		yield(VisualServer, "frame_post_draw")
		var image := view.get_texture().get_data()
		image.convert(Image.FORMAT_RGB8)
		if image.save_png(picture.file) != OK:
			printerr("cannot write " + picture.file)
			quit(1)
			return
	quit(0)


func _add_camera():
	var camera := Camera.new()
	view.add_child(camera)
	camera.fov = job.camera.fov_y_degrees
	camera.near = 0.05
	camera.far = 10.0
	camera.look_at_from_position(_vector(job.camera.position), _vector(job.camera.target), Vector3.UP)
	var environment := Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.ambient_light_energy = 0.0
	camera.environment = environment
	camera.current = true


func _vector(list: Array) -> Vector3:
	return Vector3(list[0], list[1], list[2])


# Vertices of 12 floats (position, normal, tangent, uv), then indices, little-endian.
func _add_mesh(description: Dictionary):
	var file := File.new()
	file.open(description.file, File.READ)
	var positions := PoolVector3Array()
	var normals := PoolVector3Array()
	var tangents := PoolRealArray()
	var uvs := PoolVector2Array()
	for _i in int(description.vertices):
		positions.append(Vector3(file.get_float(), file.get_float(), file.get_float()))
		normals.append(Vector3(file.get_float(), file.get_float(), file.get_float()))
		for _j in 4:
			tangents.append(file.get_float())
		uvs.append(Vector2(file.get_float(), file.get_float()))
	var indices := PoolIntArray()
	for _i in int(description.indices):
		indices.append(file.get_32())
	file.close()
	var arrays := []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = positions
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_TANGENT] = tangents
	arrays[Mesh.ARRAY_TEX_UV] = uvs
	arrays[Mesh.ARRAY_INDEX] = indices
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays, [], 0)
	var old := SpatialMaterial.new()
	old.resource_name = description.material
	mesh.surface_set_material(0, old)
	var instance := MeshInstance.new()
	instance.mesh = mesh
	view.add_child(instance)
	if wrinkles.apply(instance) != 1:
		printerr("no material for " + description.material)
		quit(1)
	_show_normals(wrinkles.material(description.material))


# The shader of the export with a light that shows the normal that Godot has computed: n * 0.5 + 0.5, in
# view space. The conversion to linear cancels the one at the end of the frame.
func _show_normals(material: ShaderMaterial):
	var shader: Shader = material.shader
	if shader.code.find("void light()") >= 0:
		return
	var code := shader.code.replace(
		"shader_type spatial;",
		"shader_type spatial;\nrender_mode specular_disabled, ambient_light_disabled, shadows_disabled, cull_disabled;")
	code = code.replace("ALBEDO = albedo * look.rgb;", "ALBEDO = vec3(1.0);")
	code = code.replace("AO = look.a;", "")
	code += """
void light() {
	vec3 shown = 0.5 * normalize(NORMAL) + vec3(0.5);
	DIFFUSE_LIGHT = mix(shown / 12.92, pow((shown + vec3(0.055)) / 1.055, vec3(2.4)), step(vec3(0.04045), shown));
}
"""
	shader.code = code
