# SPDX-License-Identifier: Apache-2.0
# Receives wrinkle weights from furrowd as JSON over a WebSocket (route /weights of the daemon's HTTP port), also in
# HTML5 exports. Connects again after every loss. Everything that arrives is checked before use.
#
#   $FurrowClient.connect("weights_changed", self, "_on_weights_changed")
#   func _on_weights_changed(subject, names, values): ...
extends Node

# A new frame. `names` and `values` have equal sizes; values are in [0, 1]. `names` is the same object until it changes.
signal weights_changed(subject, names, values)
# The subject has left; it may return.
signal subject_gone(subject)
signal state_changed(state)

enum State { CLOSED, CONNECTING, CONNECTED, LOST }

const SETTINGS = preload("furrow_settings.gd")
const MAX_WEIGHTS = 2048
const MAX_SUBJECTS = 256
const MAX_ASKED = 64  # subjects of one connection, the daemon's limit
const MAX_SEQUENCE = 4294967296.0
# Godot 3 reads JSON recursively without a limit, and some 16,000 levels overflow its stack. The daemon nests 2 deep, but
# names may contain brackets.
const MAX_BRACKETS = 4096
const FIRST_PAUSE_MSEC = 100
const MAX_PAUSE_MSEC = 800
# A message that arrives this long after opening proves that the connection works. An earlier one may be a refusal.
const PROVEN_MSEC = 1000
const CONNECT_MSEC = 5000
# The daemon sends an object at least every 10 s. A silent connection is dead and is replaced.
const SILENCE_MSEC = 30000

# HOST:PORT of the daemon's HTTP server; empty: the setting of the project.
export var address = ""
# The subject to follow. Empty: the oldest.
export(PoolStringArray) var subjects = PoolStringArray()
# Names of the weights, as comma-separated globs; empty: all.
export var pattern = ""
# The text of a connect token, for daemons that require one (docs/TOKENS.md).
export var token = ""
# Permits the token to another computer, where everybody on the way can read it: Godot 3 knows no TLS 1.3.
export var token_in_clear = false
# Late frames queue at the daemon; false: newer frames replace them, which is better on slow networks.
export var every_frame = true
export var open_on_ready = true

var state = State.CLOSED
var last_error = ""

var _socket = null
var _is_polling = false
var _is_wanted = false  # open() was called, and close() was not
var _is_lost = false  # the socket has ended
var _pause_msec = FIRST_PAUSE_MSEC
var _due_msec = 0
var _heard_msec = 0
var _opened_msec = 0
var _streams = {}  # subject -> Stream


# The state of one subject.
class Stream:
	var names = PoolStringArray()
	var values = PoolRealArray()
	var sequence = -1
	var time_us = 0.0  # capture time, on the publisher's clock
	var age_ms = 0.0  # time without a new pose when the frame was sent
	var timecode = ""  # SMPTE, of the pose: "10:00:00:00", ';' before the frames of drop-frame; "": its source sends none
	var received_msec = 0
	var frames = 0
	var missed = 0
	var gone = false


func _ready():
	if open_on_ready:
		open()


func _exit_tree():
	close()


func _process(_delta):
	poll()


# Opens the connection and keeps it open until close().
func open():
	if _is_polling:  # a receiver of a signal calls: begin again as after a loss
		_is_wanted = true
		_is_lost = true
		return
	close()
	last_error = ""
	_is_wanted = true
	_pause_msec = FIRST_PAUSE_MSEC
	_begin()


# Ends the connection. Frames that have arrived stay readable. Receivers of signals may call it, too.
func close():
	_is_wanted = false
	last_error = ""
	if _socket != null and not _is_polling:
		_socket.disconnect_from_host()
		_socket = null
	if _socket == null:
		_set_state(State.CLOSED)


# Does all the work; _process() calls it. Call it yourself if the node does not process.
func poll():
	if state == State.CLOSED:
		return
	var now = OS.get_ticks_msec()
	if _socket == null:
		if now >= _due_msec:
			_begin()
		return
	# A socket must not be freed inside its own signals, so they only note what happened.
	_is_polling = true
	_socket.poll()
	_is_polling = false
	if not _is_wanted:
		close()
		return
	if _is_lost:
		_lose("no connection to " + get_address() + "; is furrowd running there?")
		return
	var limit = CONNECT_MSEC if state != State.CONNECTED else SILENCE_MSEC
	if now - _heard_msec > limit:
		_lose("no answer from " + get_address())


func get_address():
	return address if address != "" else SETTINGS.read(SETTINGS.ADDRESS)


# The subjects that have been seen.
func get_subjects():
	return _streams.keys()


# The state of a subject: names, values, sequence, time_us, timecode, frames, missed, gone; null before its first names.
func get_stream(subject):
	return _streams.get(subject)


# Milliseconds since the pose of the newest frame; -1 before the first.
func get_age_msec(subject):
	var stream = _streams.get(subject)
	if stream == null or stream.frames == 0:
		return -1
	return stream.age_ms + OS.get_ticks_msec() - stream.received_msec


# One line for people.
func get_status():
	match state:
		State.CLOSED:
			return "not connected" if last_error == "" else "not connected: " + last_error
		State.CONNECTED:
			return "connected to " + get_address()
		State.LOST:
			return "connection lost, trying again: " + get_address()
	return "connecting to " + get_address()


# One line about a subject: age of the last frame and losses.
func get_subject_status(subject):
	var stream = _streams.get(subject)
	if stream == null:
		return last_error if last_error != "" else "waiting for the subject"
	if stream.gone:
		return "the subject has left"
	return "%d ms old, %d missed" % [get_age_msec(subject), stream.missed]


func _begin():
	if subjects.size() > MAX_ASKED:
		_give_up("%d subjects, but one FurrowClient follows at most %d; use another for more" % [subjects.size(), MAX_ASKED])
		return
	if token != "" and not token_in_clear and not _is_this_computer(get_address()):
		_give_up("the token would travel to %s unencrypted; set token_in_clear to send it anyway" % get_address())
		return
	_set_state(State.CONNECTING if state != State.LOST else State.LOST)
	_heard_msec = OS.get_ticks_msec()
	_is_lost = false
	_socket = WebSocketClient.new()
	# A list of 2,048 names has at most 540 KB.
	_socket.set_buffers(1024, 4096, 16, 16)
	_socket.connect("connection_established", self, "_on_established")
	_socket.connect("connection_closed", self, "_on_closed")
	_socket.connect("connection_error", self, "_on_closed", [false])
	_socket.connect("data_received", self, "_on_data")
	if _socket.connect_to_url("ws://" + get_address() + "/weights?" + _query()) != OK:
		_lose("'" + get_address() + "' is not HOST:PORT")


static func _is_this_computer(host_and_port):
	var host = host_and_port.substr(0, host_and_port.find_last(":")).trim_prefix("[").trim_suffix("]")
	return host == "localhost" or host == "::1" or (host.begins_with("127.") and host.is_valid_ip_address())


func _query():
	var parts = PoolStringArray()
	for subject in subjects:
		var part = "subject=" + subject.percent_encode()
		if not part in parts:  # the daemon refuses repeated names
			parts.append(part)
	if pattern != "":
		parts.append("pattern=" + pattern.percent_encode())
	parts.append("every=" + ("true" if every_frame else "false"))
	var rate = float(SETTINGS.read(SETTINGS.RATE))
	if rate > 0.0:
		parts.append("rate=" + str(rate))
	if token != "":
		parts.append("token=" + token.percent_encode())
	return parts.join("&")


func _on_established(_protocol):
	_heard_msec = OS.get_ticks_msec()
	_opened_msec = _heard_msec
	last_error = ""
	_set_state(State.CONNECTED)


func _on_closed(_was_clean):
	_is_lost = true


func _lose(why):
	last_error = why
	_socket = null
	_due_msec = OS.get_ticks_msec() + _pause_msec
	_pause_msec = min(2 * _pause_msec, MAX_PAUSE_MSEC)
	_set_state(State.LOST)


# Ends the attempts: only the game can help.
func _give_up(why):
	_is_wanted = false
	last_error = why
	push_error("Furrow: " + why)
	_set_state(State.CLOSED)


func _set_state(to):
	if state != to:
		state = to
		emit_signal("state_changed", state)


func _on_data():
	_heard_msec = OS.get_ticks_msec()
	if _heard_msec - _opened_msec >= PROVEN_MSEC:
		_pause_msec = FIRST_PAUSE_MSEC
	_on_message(_socket.get_peer(1).get_packet().get_string_from_utf8())


# Takes one message. Anything that is not as the daemon writes it is ignored.
func _on_message(text):
	if text.length() > MAX_BRACKETS and _count(text, "[") + _count(text, "{") > MAX_BRACKETS:
		return
	var parsed = JSON.parse(text)
	if parsed.error != OK or typeof(parsed.result) != TYPE_DICTIONARY:
		return
	var message = parsed.result
	match message.get("type"):
		"names":
			_on_names(message)
		"weights":
			_on_weights(message)
		"gone":
			_on_gone(message)
		"error":
			last_error = str(message.get("message", ""))


# How often a character occurs; counts no further than just beyond MAX_BRACKETS.
func _count(text, character):
	return text.split(character, true, MAX_BRACKETS + 1).size() - 1


func _on_names(message):
	var subject = message.get("subject")
	var names = message.get("names")
	if typeof(subject) != TYPE_STRING or typeof(names) != TYPE_ARRAY or names.size() > MAX_WEIGHTS:
		return
	if not _streams.has(subject):
		if _streams.size() >= MAX_SUBJECTS:
			return
		_streams[subject] = Stream.new()
	var stream = _streams[subject]
	var fresh = PoolStringArray(names)
	if fresh != stream.names:
		stream.names = fresh
		stream.values = PoolRealArray()
	stream.gone = false


func _on_weights(message):
	var stream = _streams.get(message.get("subject"))
	var values = message.get("values")
	var sequence = message.get("sequence")
	if stream == null or typeof(values) != TYPE_ARRAY or typeof(sequence) != TYPE_REAL:
		return
	if values.size() != stream.names.size() or not (sequence >= 0.0 and sequence < MAX_SEQUENCE):
		return
	var fresh = PoolRealArray(values)
	for i in fresh.size():
		if not (fresh[i] >= 0.0 and fresh[i] <= 1.0):
			fresh[i] = clamp(fresh[i], 0.0, 1.0) if fresh[i] == fresh[i] else 0.0
	var ahead = int(sequence) - stream.sequence
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
	stream.received_msec = OS.get_ticks_msec()
	stream.frames += 1
	stream.gone = false
	emit_signal("weights_changed", message.subject, stream.names, stream.values)


func _on_gone(message):
	var stream = _streams.get(message.get("subject"))
	if stream != null and not stream.gone:
		stream.gone = true
		emit_signal("subject_gone", message.subject)


# The longest is "23:59:59:239".
func _timecode(value):
	return value if typeof(value) == TYPE_STRING and value.length() <= 12 else ""


func _number(value):
	return value if typeof(value) == TYPE_REAL else 0.0
