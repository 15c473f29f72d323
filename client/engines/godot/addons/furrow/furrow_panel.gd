# SPDX-License-Identifier: Apache-2.0
# A panel for the running game: status, connect and disconnect, record and clear.
extends PanelContainer

export(NodePath) var client
export(NodePath) var target
export(NodePath) var recorder

var _status
var _subject
var _connect
var _record


func _ready():
	var box = VBoxContainer.new()
	add_child(box)
	_status = Label.new()
	_subject = Label.new()
	box.add_child(_status)
	box.add_child(_subject)
	_connect = _button(box, "Connect", "_on_connect")
	if has_node(recorder):
		_record = _button(box, "Record", "_on_record")
		var _clear = _button(box, "Clear", "_on_clear")


func _process(_delta):
	var source = get_node(client)
	var is_open = source.state != source.State.CLOSED
	_status.text = source.get_status()
	_connect.text = "Disconnect" if is_open else "Connect"
	if has_node(target):
		var one = get_node(target)
		_subject.text = "%s: %s, %d of %d names in use" % [one.subject if one.subject != "" else "oldest",
				source.get_subject_status(one.subject), one.covered(), one.names.size()]
	if _record != null:
		_record.text = "Stop" if get_node(recorder).recording else "Record"


func _button(box, text, method):
	var button = Button.new()
	button.text = text
	button.connect("pressed", self, method)
	box.add_child(button)
	return button


func _on_connect():
	var source = get_node(client)
	if source.state == source.State.CLOSED:
		source.open()
	else:
		source.close()


func _on_record():
	var one = get_node(recorder)
	if one.recording:
		one.stop()
	else:
		one.start()


func _on_clear():
	get_node(recorder).clear()
