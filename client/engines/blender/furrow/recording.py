# SPDX-License-Identifier: Apache-2.0
"""Frames to keyframes on the timeline, and keyframes away again."""
import re

import bpy

from .targets import PREFIX, property_name

# Ten minutes at 240 frames per second. A recording ends there and does not fill the memory.
MAX_FRAMES = 144_000
GROUP = "Furrow"


class Take:
    """The frames of one subject since recording began. The first frame falls on `start`."""

    def __init__(self, start, frames_per_second):
        self.start = start  # scene frame
        self.frames_per_second = frames_per_second
        self.names = []
        self.times = []  # scene frames, ascending
        self.rows = []
        self._first_us = None
        self._last_us = None

    @property
    def full(self):
        return len(self.times) >= MAX_FRAMES

    def add(self, names, frame):
        """Adds a frame. Faded frames and frames of other names are skipped: they belong to no pose."""
        if self.full or frame.decaying or (self.names and names != self.names):
            return
        if self._first_us is None:
            self.names, self._first_us = names, frame.capture_time_us
        elif frame.capture_time_us <= self._last_us:
            if frame.capture_time_us > self._first_us:
                return  # out of order
            # The publisher has restarted with another clock: continue one frame after the last.
            self._first_us = frame.capture_time_us - round((self.times[-1] - self.start + 1) * 1e6 /
                                                           self.frames_per_second)
        self._last_us = frame.capture_time_us
        self.times.append(self.start + (frame.capture_time_us - self._first_us) * 1e-6 * self.frames_per_second)
        self.rows.append(frame.values)

    def write(self, target):
        """Writes the frames as linear keyframes: custom properties, and shape keys of the same names. Replaces
        earlier recordings on these channels. Returns the number of keyframes per channel."""
        if not self.times:
            return 0
        keys = getattr(target.data, "shape_keys", None)
        for index, name in enumerate(self.names):
            column = [row[index] for row in self.rows]
            prop = property_name(name)
            self._write_curve(target, f'["{prop}"]', column)
            for key in (prop, name):
                if keys and key in keys.key_blocks:
                    self._write_curve(keys, f'key_blocks["{bpy.utils.escape_identifier(key)}"].value', column)
        return len(self.times)

    def _write_curve(self, owner, path, column):
        curves = _action_of(owner).fcurves
        old = curves.find(path)
        if old:
            curves.remove(old)
        curve = curves.new(path, action_group=GROUP)
        curve.keyframe_points.add(len(column))
        curve.keyframe_points.foreach_set("co", [x for pair in zip(self.times, column) for x in pair])
        # One call instead of one per keyframe: a take of ten minutes has millions.
        linear = bpy.types.Keyframe.bl_rna.properties["interpolation"].enum_items["LINEAR"].value
        curve.keyframe_points.foreach_set("interpolation", [linear] * len(column))
        curve.update()


def _action_of(owner):
    """The action that holds the curves; an existing one is kept, with its other channels."""
    animation = owner.animation_data or owner.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(f"Furrow {owner.name}")
    return animation.action


def clear(target):
    """Removes all keyframes of weights from an object. Returns the number of channels that were removed."""
    count = 0
    for owner in (target, getattr(target.data, "shape_keys", None)):
        animation = getattr(owner, "animation_data", None)
        action = animation.action if animation else None
        if action is None:
            continue
        for curve in [curve for curve in action.fcurves if _is_ours(curve)]:
            action.fcurves.remove(curve)
            count += 1
        if not action.fcurves:
            animation.action = None
            if action.users == 0:
                bpy.data.actions.remove(action)
    return count


def _is_ours(curve):
    in_group = curve.group is not None and curve.group.name == GROUP
    return bool(re.match(rf'\["{PREFIX}\w+"\]$', curve.data_path)) or (
        in_group and curve.data_path.startswith("key_blocks["))
