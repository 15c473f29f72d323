# SPDX-License-Identifier: Apache-2.0
"""One connection and the objects that its subjects drive. poll() does all the work; nothing runs on other threads.

A timer calls poll() in the window. In background (blender -b) timers never fire: call poll() yourself.
"""
import time

import bpy

from . import library, recording
from .targets import Targets

# How often what costs time is looked up again, seconds: coverage, and subjects in the list of objects.
_REFRESH = 1.0
MAX_FRAME = 1_048_574  # Blender's last frame


class Binding:
    """A subject on an object while the connection is open."""

    def __init__(self, subject):
        self.subject = subject  # as asked for; "" means the oldest
        self.daemon_name = subject
        self.layout = 0
        self.names = []
        self.targets = {}  # object name -> Targets
        self.frames = 0
        self.state = None
        self.covered = 0
        self.takes = {}  # object name -> Take, while recording
        self._last = None

    def is_repeated(self, frame):
        """True if this frame came already: a subject that was asked for by name and as the oldest arrives twice."""
        key = (frame.sequence, frame.capture_time_us)
        repeated = not frame.decaying and key == self._last
        self._last = key
        return repeated


class Session:
    """Use one per Blender; `session` below is it."""

    def __init__(self):
        self.connection = None
        self.error = ""
        self.bindings = {}  # subject as asked for -> Binding
        self.recording = False
        self.on_frame = None  # called with every Frame, for tests and scripts
        self._refreshed = 0.0

    @property
    def connected(self):
        return self.connection is not None and self.connection.state() == library.CONNECTED

    def connect(self, address, library_path=""):
        """Opens a connection and returns at once; poll() connects. Raises library.FurrowError."""
        self.disconnect()
        self.error = ""
        self.connection = library.Connection(library.load(library_path), address)
        self._refreshed = 0.0

    def disconnect(self):
        """Ends the connection. A recording in progress is dropped. Objects keep their last weights."""
        self.recording = False
        if self.connection is not None:
            self.connection.close()
        self.connection = None
        self.bindings = {}

    def poll(self, scene):
        """Receives, and applies the newest weights to the objects of the scene's list. Returns the number of
        frames that arrived."""
        if self.connection is None:
            return 0
        self._follow(scene)
        frames = self.connection.poll()
        newest = {}
        for frame in frames:
            if self.on_frame:
                self.on_frame(frame)
            for binding in self.bindings.values():
                if binding.daemon_name == frame.subject and not binding.is_repeated(frame):
                    binding.frames += 1
                    newest[binding.subject] = frame
                    for take in binding.takes.values():
                        take.add(binding.names, frame)
        self._apply(scene, newest)
        self._refresh(scene)
        return len(frames)

    def _follow(self, scene):
        """Subscribes to the subjects of the scene's list, and reads what the daemon answered."""
        wanted = {row.subject for row in scene.furrow.rows}
        for subject in [subject for subject in self.bindings if subject not in wanted]:
            self.connection.unsubscribe(subject)
            del self.bindings[subject]
        for subject in wanted - self.bindings.keys():
            self.connection.subscribe(subject)
            self.bindings[subject] = Binding(subject)
        for index, binding in enumerate(self.bindings.values()):
            if not binding.subject:
                binding.daemon_name = self.connection.subject_name(index)
            layout = self.connection.layout(binding.subject)
            if layout != binding.layout:
                binding.layout, binding.names = layout, self.connection.names(binding.subject)
                binding.targets = {}

    def _apply(self, scene, newest):
        for row in scene.furrow.rows:
            binding = self.bindings.get(row.subject)
            target = row.target
            if binding is None or target is None or not binding.names:
                continue
            if target.name not in binding.targets:
                binding.targets[target.name] = Targets(target, binding.names)
            frame = newest.get(row.subject)
            if frame is not None and len(frame.values) == len(binding.names):
                binding.targets[target.name].apply(target, frame.values)

    def _refresh(self, scene):
        for binding in self.bindings.values():
            binding.state = self.connection.subject_state(binding.subject)
        now = time.monotonic()
        if now - self._refreshed < _REFRESH:
            return
        self._refreshed = now
        for row in scene.furrow.rows:
            binding = self.bindings.get(row.subject)
            if binding and row.target and row.target.name in binding.targets:
                binding.covered = binding.targets[row.target.name].covered(row.target)

    def status(self):
        """One line about the connection."""
        if self.connection is None:
            return self.error or "not connected"
        state = self.connection.state()
        if state == library.CONNECTED:
            return "connected"
        return "connecting" if state == library.CONNECTING else "connection lost, trying again"

    def row_status(self, row):
        """One line about a subject: age of the last frame, losses, names covered."""
        binding = self.bindings.get(row.subject)
        if binding is None or binding.state is None:
            return "not connected" if self.connection is None else "waiting for the daemon"
        state = binding.state
        if state.status != library.OK:
            return "waiting for the subject" if state.status == library.NO_DATA else state.text
        what = "the subject has left" if state.gone else f"{state.age_us / 1000:.0f} ms old"
        if state.decaying and not state.gone:
            what += ", no new poses"
        return f"{what}, {state.missed} missed, {binding.covered} of {len(binding.names)} names in use"

    def start_recording(self, scene):
        """Starts to record all rows at the current frame of the timeline."""
        rate = scene.render.fps / scene.render.fps_base
        for row in scene.furrow.rows:
            binding = self.bindings.get(row.subject)
            if binding and row.target:
                binding.takes[row.target.name] = recording.Take(scene.frame_current, rate)
        self.recording = True

    def stop_recording(self, scene):
        """Writes the keyframes. Returns the number of frames of the longest take."""
        self.recording = False
        longest = 0
        for row in scene.furrow.rows:
            binding = self.bindings.get(row.subject)
            take = binding.takes.pop(row.target.name, None) if binding and row.target else None
            if take:
                longest = max(longest, take.write(row.target))
                if take.times:
                    # Capture times come from the network: a publisher's clock may jump by years.
                    scene.frame_end = max(scene.frame_end, min(int(take.times[-1]) + 1, MAX_FRAME))
        return longest


session = Session()
_drawn = 0.0  # when the timer last redrew the sidebar


def tick():
    """The timer: polls the session and redraws the sidebar. Returns the seconds until the next call."""
    global _drawn  # pylint: disable=global-statement
    try:
        frames = session.poll(bpy.context.scene)
        # Also without frames, so that the panel shows how old the last one is.
        if frames or time.monotonic() - _drawn > _REFRESH:
            _drawn = time.monotonic()
            for window in bpy.context.window_manager.windows:
                for area in window.screen.areas:
                    if area.type == "VIEW_3D":
                        area.tag_redraw()
    except Exception as error:  # pylint: disable=broad-except
        # Blender drops a timer that raises, and the panel would go on to say that it is connected.
        session.disconnect()
        session.error = str(error)
    return 1 / 120 if session.connection is not None else 0.5
