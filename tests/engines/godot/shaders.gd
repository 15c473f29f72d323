# SPDX-License-Identifier: Apache-2.0
# Runs in godot3-runner, which has a renderer: weights reach the uniforms of exported wrinkle materials. godot3-server keeps
# no shaders.
extends SceneTree

const TARGET = preload("res://addons/furrow/furrow_target.gd")


func _init():
	var arrays = []
	arrays.resize(ArrayMesh.ARRAY_MAX)
	arrays[ArrayMesh.ARRAY_VERTEX] = PoolVector3Array([Vector3(), Vector3(1, 0, 0), Vector3(0, 1, 0)])
	var mesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	var material = ShaderMaterial.new()
	material.shader = Shader.new()
	material.shader.code = "shader_type spatial; uniform float furrow_brow_r_squash; uniform lowp float furrow_other;"
	mesh.surface_set_material(0, material)
	var instance = MeshInstance.new()
	instance.mesh = mesh
	instance.name = "Face"
	var parent = Spatial.new()
	parent.name = "Character"
	parent.add_child(instance)
	root.add_child(parent)
	var target = TARGET.new()
	target.mesh = NodePath("../Character")
	root.add_child(target)
	target._on_weights_changed("ada", PoolStringArray(["nose.squash", "brow_r.squash"]), PoolRealArray([0.25, 0.75]))
	target.apply()
	print("furrow-test: " + JSON.print({"event": "shader", "value": material.get_shader_param("furrow_brow_r_squash"),
			"covered": target.covered()}))
	quit()
