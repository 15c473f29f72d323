# SPDX-License-Identifier: Apache-2.0
# The client against messages that no daemon sends: truncated, of wrong types, with counts that lie. Nothing may fail, and
# nothing may be taken for weights.
extends SceneTree

const CLIENT = preload("res://addons/furrow/furrow_client.gd")
const NAMES = '{"type": "names", "subject": "ada", "names": ["a", "b"]}'
const WEIGHTS = '{"type": "weights", "subject": "ada", "sequence": 7, "time_us": 5, "age_ms": 0, "values": [0.5, 1e-3]}'
const STRANGE = [
	"", "null", "3", "[]", "{}", '{"type": 3}', '{"type": "names"}', '{"type": "names", "subject": "ada", "names": {}}',
	'{"type": "names", "subject": ["ada"], "names": []}', '{"type": "weights", "subject": {}, "values": []}',
	'{"type": "weights", "subject": "ada", "sequence": 8, "values": [0.5]}',
	'{"type": "weights", "subject": "ada", "sequence": 8, "values": [0.5, 0.5, 0.5]}',
	'{"type": "weights", "subject": "ada", "sequence": "8", "values": [0.5, 0.5]}',
	'{"type": "weights", "subject": "ada", "sequence": -1, "values": [0.5, 0.5]}',
	'{"type": "weights", "subject": "ada", "sequence": 1e300, "values": [0.5, 0.5]}',
	'{"type": "weights", "subject": "bob", "sequence": 8, "values": [0.5, 0.5]}',
	'{"type": "gone", "subject": "bob"}', '{"type": "gone"}', '{"type": "error"}', '{"type": "bye"}',
]

var client = CLIENT.new()
var frames = 0


func _on_weights(_subject, names, values):
	frames += 1
	for value in values:
		if names.size() != values.size() or not (value >= 0.0 and value <= 1.0):
			print("FAILED: ", values)


func _init():
	if client.connect("weights_changed", self, "_on_weights") != OK:
		print("FAILED: the signal")
	for size in NAMES.length():
		client._on_message(NAMES.left(size))
	for text in STRANGE:
		client._on_message(text)
	for opening in ["[", '{"a":']:
		client._on_message(opening.repeat(1000000 / opening.length()))
		client._on_message('{"type": "names", "subject": "ada", "names": [' + opening.repeat(100000))
	var before_names = frames
	client._on_message(NAMES)
	for size in WEIGHTS.length():
		client._on_message(WEIGHTS.left(size))
	for text in STRANGE:
		client._on_message(text)
	var strange = frames
	client._on_message(WEIGHTS)
	var good = frames
	client._on_message('{"type": "weights", "subject": "ada", "sequence": 7, "values": [0, 1], "timecode": "10:00:00;02"}')
	var timecodes = [client.get_stream("ada").timecode]
	for timecode in ["[1]", '"%s"' % "9".repeat(13)]:
		client._on_message('{"type": "weights", "subject": "ada", "sequence": 7, "values": [0, 1], "timecode": %s}' % timecode)
		timecodes.append(client.get_stream("ada").timecode)
	# Numbers outside of [0, 1], and what are no numbers.
	client._on_message('{"type": "weights", "subject": "ada", "sequence": 9, "values": [-7, 1e300]}')
	client._on_message('{"type": "weights", "subject": "ada", "sequence": 10, "values": [null, "x"]}')
	for i in 1000:
		client._on_message('{"type": "names", "subject": "s%d", "names": []}' % i)
	# More subjects than the daemon accepts.
	var many = PoolStringArray()
	for i in 65:
		many.append("s%d" % i)
	client.subjects = many
	client.open()
	print("furrow-test: " + JSON.print({"event": "hostile", "before_names": before_names, "strange": strange, "good": good,
			"subjects": client.get_subjects().size(), "missed": client.get_stream("ada").missed,
			"too_many": client.get_status(), "timecodes": timecodes}))
	client.free()
	quit()
