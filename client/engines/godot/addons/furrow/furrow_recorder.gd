# SPDX-License-Identifier: Apache-2.0
# Records a FurrowTarget to an animation of an AnimationPlayer, and removes it again.
extends Node

# Ten minutes at 240 frames per second. A recording ends there and does not fill the memory.
const MAX_FRAMES = 144000

export(NodePath) var client
export(NodePath) var target
export(NodePath) var player
export var animation_name = "furrow"

var recording = false

var _names = PoolStringArray()
var _times = PoolRealArray()
var _rows = []
var _first_us = 0.0
var _last_us = 0.0


func _ready():
	if has_node(client):
		get_node(client).connect("weights_changed", self, "_on_weights_changed")


func start():
	_names = PoolStringArray()
	_times = PoolRealArray()
	_rows = []
	recording = true


# Ends the recording and adds the animation to the player, in place of an earlier one. Returns the animation; null if
# nothing was recorded.
func stop():
	recording = false
	if _times.size() == 0:
		return null
	var animation = Animation.new()
	animation.length = max(_times[_times.size() - 1], 0.001)
	var node = _player_root().get_path_to(get_node(target))
	for i in _names.size():
		var track = animation.add_track(Animation.TYPE_VALUE)
		animation.track_set_path(track, str(node) + ":" + get_node(target).property_name(_names[i]))
		animation.value_track_set_update_mode(track, Animation.UPDATE_CONTINUOUS)
		for j in _times.size():
			animation.track_insert_key(track, _times[j], _rows[j][i])
	clear()
	get_node(player).add_animation(animation_name, animation)
	return animation


# Removes the recorded animation from the player. Returns whether there was one.
func clear():
	var owner_of_it = get_node(player)
	if not owner_of_it.has_animation(animation_name):
		return false
	owner_of_it.remove_animation(animation_name)
	return true


func _player_root():
	var animation_player = get_node(player)
	return animation_player.get_node(animation_player.root_node)


func _on_weights_changed(subject, names, values):
	if not recording or subject != get_node(target).subject or _times.size() >= MAX_FRAMES:
		return
	var stream = get_node(client).get_stream(subject)
	# Faded frames belong to no pose, and frames of another rig have other names.
	if stream.age_ms > 0.0 or (_names.size() > 0 and names != _names):
		return
	if _times.size() == 0:
		_names = names
		_first_us = stream.time_us
	elif stream.time_us <= _last_us:
		return  # out of order, or the publisher has restarted with another clock
	_last_us = stream.time_us
	_times.append((stream.time_us - _first_us) * 1e-6)
	_rows.append(values)
