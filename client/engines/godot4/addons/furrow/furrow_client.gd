# SPDX-License-Identifier: Apache-2.0
# NOT RUN: a port of the add-on for Godot 3. Receives wrinkle weights from furrowd as JSON over a WebSocket (route /weights
# of the daemon's HTTP port), and connects again after every loss.
extends Node

# A new frame. `names` and `values` have equal sizes; values are in [0, 1].
signal weights_changed(subject: String, names: PackedStringArray, values: PackedFloat32Array)
signal subject_gone(subject: String)
signal state_changed(state: int)

enum State { CLOSED, CONNECTING, CONNECTED, LOST }

const MAX_WEIGHTS := 2048
const MAX_SUBJECTS := 256
const MAX_ASKED := 64  # subjects of one connection, the daemon's limit
const MAX_SEQUENCE := 4294967296.0
const FIRST_PAUSE_MSEC := 100
const MAX_PAUSE_MSEC := 800
# A message that arrives this long after opening proves that the connection works. An earlier one may be a refusal.
const PROVEN_MSEC := 1000
const CONNECT_MSEC := 5000
# The daemon sends an object at least every 10 s. A silent connection is dead and is replaced.
const SILENCE_MSEC := 30000

# HOST:PORT of the daemon's HTTP server; empty: the setting of the project.
@export var address := ""
# The subject to follow. Empty: the oldest.
@export var subjects := PackedStringArray()
# Names of the weights, as comma-separated globs; empty: all.
@export var pattern := ""
# The text of a connect token, for daemons that require one (docs/TOKENS.md).
@export var token := ""
# Permits the token to another computer, where everybody on the way can read it.
@export var token_in_clear := false
# Late frames queue at the daemon; false: newer frames replace them, which is better on slow networks.
@export var every_frame := true
@export var open_on_ready := true

var state := State.CLOSED
var last_error := ""

var _socket: WebSocketPeer = null
var _pause_msec := FIRST_PAUSE_MSEC
var _due_msec := 0
var _heard_msec := 0
var _opened_msec := 0
var _streams := {}  # subject -> Stream


# The state of one subject.
class Stream:
	var names := PackedStringArray()
	var values := PackedFloat32Array()
	var sequence := -1
	var time_us := 0.0
	var age_ms := 0.0
	var timecode := ""  # SMPTE, of the pose: "10:00:00:00", ';' before the frames of drop-frame; "": its source sends none
	var received_msec := 0
	var frames := 0
	var missed := 0
	var gone := false


func _ready() -> void:
	if open_on_ready:
		open()


func _exit_tree() -> void:
	close()


func _process(_delta: float) -> void:
	poll()


func open() -> void:
	close()
	last_error = ""
	_pause_msec = FIRST_PAUSE_MSEC
	_begin()


func close() -> void:
	last_error = ""
	if _socket != null:
		_socket.close()
		_socket = null
	_set_state(State.CLOSED)


# Does all the work; _process() calls it.
func poll() -> void:
	if state == State.CLOSED:
		return
	var now := Time.get_ticks_msec()
	if _socket == null:
		if now >= _due_msec:
			_begin()
		return
	var socket := _socket
	socket.poll()
	if socket.get_ready_state() == WebSocketPeer.STATE_OPEN:
		if state != State.CONNECTED:
			_opened_msec = now
			_heard_msec = now
			last_error = ""
			_set_state(State.CONNECTED)
		while _socket == socket and socket.get_available_packet_count() > 0:
			_heard_msec = now
			if now - _opened_msec >= PROVEN_MSEC:
				_pause_msec = FIRST_PAUSE_MSEC
			_on_message(socket.get_packet().get_string_from_utf8())
	elif socket.get_ready_state() == WebSocketPeer.STATE_CLOSED:
		_lose("no connection to " + get_address() + "; is furrowd running there?")
		return
	var limit := CONNECT_MSEC if state != State.CONNECTED else SILENCE_MSEC
	if _socket != null and now - _heard_msec > limit:
		_lose("no answer from " + get_address())


func get_address() -> String:
	return address if address != "" else str(ProjectSettings.get_setting("furrow/network/address", "127.0.0.1:7480"))


# The state of a subject; null before its first names.
func get_stream(subject: String) -> Stream:
	return _streams.get(subject)


func get_status() -> String:
	match state:
		State.CLOSED:
			return "not connected" if last_error == "" else "not connected: " + last_error
		State.CONNECTED:
			return "connected to " + get_address()
		State.LOST:
			return "connection lost, trying again: " + get_address()
	return "connecting to " + get_address()


func get_subject_status(subject: String) -> String:
	var stream := get_stream(subject)
	if stream == null:
		return last_error if last_error != "" else "waiting for the subject"
	if stream.gone:
		return "the subject has left"
	return "%d ms old, %d missed" % [stream.age_ms + Time.get_ticks_msec() - stream.received_msec, stream.missed]


func _begin() -> void:
	if subjects.size() > MAX_ASKED:
		_give_up("%d subjects, but one FurrowClient follows at most %d; use another for more" % [subjects.size(), MAX_ASKED])
		return
	if token != "" and not token_in_clear and not _is_this_computer(get_address()):
		_give_up("the token would travel to %s unencrypted; set token_in_clear to send it anyway" % get_address())
		return
	_set_state(State.LOST if state == State.LOST else State.CONNECTING)
	_heard_msec = Time.get_ticks_msec()
	_socket = WebSocketPeer.new()
	_socket.inbound_buffer_size = 1 << 20  # a list of 2,048 names has at most 540 KB
	_socket.max_queued_packets = 4096
	if _socket.connect_to_url("ws://" + get_address() + "/weights?" + _query()) != OK:
		_lose("'" + get_address() + "' is not HOST:PORT")


static func _is_this_computer(host_and_port: String) -> bool:
	var host := host_and_port.substr(0, host_and_port.rfind(":")).trim_prefix("[").trim_suffix("]")
	return host == "localhost" or host == "::1" or (host.begins_with("127.") and host.is_valid_ip_address())


func _query() -> String:
	var parts := PackedStringArray()
	for subject in subjects:
		var part := "subject=" + subject.uri_encode()
		if not part in parts:  # the daemon refuses repeated names
			parts.append(part)
	if pattern != "":
		parts.append("pattern=" + pattern.uri_encode())
	parts.append("every=" + ("true" if every_frame else "false"))
	if token != "":
		parts.append("token=" + token.uri_encode())
	return "&".join(parts)


func _lose(why: String) -> void:
	last_error = why
	_socket = null
	_due_msec = Time.get_ticks_msec() + _pause_msec
	_pause_msec = mini(2 * _pause_msec, MAX_PAUSE_MSEC)
	_set_state(State.LOST)


# Ends the attempts: only the game can help.
func _give_up(why: String) -> void:
	last_error = why
	push_error("Furrow: " + why)
	_set_state(State.CLOSED)


func _set_state(to: int) -> void:
	if state != to:
		state = to
		state_changed.emit(state)


func _on_message(text: String) -> void:
	var parsed: Variant = JSON.parse_string(text)
	if typeof(parsed) != TYPE_DICTIONARY:
		return
	var message: Dictionary = parsed
	match message.get("type"):
		"names":
			_on_names(message)
		"weights":
			_on_weights(message)
		"gone":
			_on_gone(message)
		"error":
			last_error = str(message.get("message", ""))


func _on_names(message: Dictionary) -> void:
	var names: Variant = message.get("names")
	if typeof(message.get("subject")) != TYPE_STRING or typeof(names) != TYPE_ARRAY or names.size() > MAX_WEIGHTS:
		return
	if not _streams.has(message.subject):
		if _streams.size() >= MAX_SUBJECTS:
			return
		_streams[message.subject] = Stream.new()
	var stream: Stream = _streams[message.subject]
	var fresh := PackedStringArray(names)
	if fresh != stream.names:
		stream.names = fresh
		stream.values = PackedFloat32Array()
	stream.gone = false


func _on_weights(message: Dictionary) -> void:
	var stream: Stream = _streams.get(message.get("subject"))
	var values: Variant = message.get("values")
	var sequence: Variant = message.get("sequence")
	if stream == null or typeof(values) != TYPE_ARRAY or typeof(sequence) != TYPE_FLOAT:
		return
	if values.size() != stream.names.size() or not (sequence >= 0.0 and sequence < MAX_SEQUENCE):
		return
	var fresh := PackedFloat32Array(values)
	for i in fresh.size():
		fresh[i] = clampf(fresh[i], 0.0, 1.0) if is_finite(fresh[i]) else 0.0
	var ahead := int(sequence) - stream.sequence
	if ahead < 0:
		ahead += 1 << 32  # the number wraps around
	# A larger gap is a restart, not a loss.
	if stream.frames > 0 and ahead > 1 and ahead < 100000:
		stream.missed += ahead - 1
	stream.values = fresh
	stream.sequence = int(sequence)
	stream.time_us = _number(message.get("time_us"))
	stream.age_ms = _number(message.get("age_ms"))
	stream.timecode = _timecode(message.get("timecode"))
	stream.received_msec = Time.get_ticks_msec()
	stream.frames += 1
	stream.gone = false
	weights_changed.emit(message.subject, stream.names, stream.values)


func _on_gone(message: Dictionary) -> void:
	var stream: Stream = _streams.get(message.get("subject"))
	if stream != null and not stream.gone:
		stream.gone = true
		subject_gone.emit(message.subject)


# The longest is "23:59:59:239".
func _timecode(value: Variant) -> String:
	return value if typeof(value) == TYPE_STRING and value.length() <= 12 else ""


func _number(value: Variant) -> float:
	return value if typeof(value) == TYPE_FLOAT else 0.0
