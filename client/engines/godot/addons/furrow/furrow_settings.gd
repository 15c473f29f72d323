# SPDX-License-Identifier: Apache-2.0
# The settings of the project, with their defaults.
extends Reference

const ADDRESS = "furrow/network/address"
const RATE = "furrow/network/rate"
const DEFAULTS = {ADDRESS: "127.0.0.1:7480", RATE: 0.0}


static func read(name):
	return ProjectSettings.get_setting(name) if ProjectSettings.has_setting(name) else DEFAULTS[name]


static func add_to_project():
	for name in DEFAULTS:
		if not ProjectSettings.has_setting(name):
			ProjectSettings.set_setting(name, DEFAULTS[name])
		ProjectSettings.set_initial_value(name, DEFAULTS[name])
	ProjectSettings.add_property_info({"name": ADDRESS, "type": TYPE_STRING})
	ProjectSettings.add_property_info(
			{"name": RATE, "type": TYPE_REAL, "hint": PROPERTY_HINT_RANGE, "hint_string": "0,1000"})
