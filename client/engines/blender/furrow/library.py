# SPDX-License-Identifier: Apache-2.0
"""libfurrow.so.1 for Python: the part of furrow/furrow.h that receives weights. Needs no Blender.

furrow.h is the manual. Names, units and limits are the same: weights are floats in [0, 1], times are integers in
microseconds. Errors raise FurrowError with the message of the library.
"""
import ctypes
import os
import pathlib

SONAME = "libfurrow.so.1"
MAX_WEIGHTS = 2048
NAME_SIZE = 256

OK, NO_DATA = 0, 2
CONNECTING, CONNECTED, DISCONNECTED = 0, 1, 2
OPEN_WITHOUT_SUBSCRIPTION = 1
FRAME_SUBJECT_GONE, FRAME_DECAYING = 1, 2


class FurrowError(Exception):
    """A function of the library failed, or the library cannot be loaded. The text says what to do."""


class _Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("program", ctypes.c_char_p),
                ("error", ctypes.c_char_p), ("error_size", ctypes.c_uint32), ("tls", ctypes.c_uint32),
                ("token", ctypes.c_char_p), ("server_key", ctypes.c_char_p), ("tls_authority", ctypes.c_char_p)]


class _Info(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("state", ctypes.c_int), ("connects", ctypes.c_uint64),
                ("malformed", ctypes.c_uint64), ("subjects", ctypes.c_uint32), ("streams", ctypes.c_uint32)]


class _Subscription(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("subject", ctypes.c_char_p),
                ("pattern", ctypes.c_char_p), ("max_rate_hz", ctypes.c_float), ("reserved", ctypes.c_uint32)]


class _Frame(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("count", ctypes.c_uint32),
                ("sequence", ctypes.c_uint32), ("layout", ctypes.c_uint64), ("number", ctypes.c_uint64),
                ("missed", ctypes.c_uint64), ("capture_time_us", ctypes.c_int64), ("age_us", ctypes.c_int64),
                ("timecode", ctypes.c_char * 16), ("timecode_rate_numerator", ctypes.c_uint32),
                ("timecode_rate_denominator", ctypes.c_uint32)]


_ON_WEIGHTS = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(_Frame),
                               ctypes.POINTER(ctypes.c_float))
_ON_LAYOUT = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_uint64,
                              ctypes.POINTER(ctypes.c_char_p), ctypes.c_uint32)


class _Callbacks(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("reserved", ctypes.c_uint32), ("user", ctypes.c_void_p),
                ("on_weights", _ON_WEIGHTS), ("on_layout", _ON_LAYOUT), ("on_subject_gone", ctypes.c_void_p),
                ("on_state", ctypes.c_void_p)]


def _sized(kind):
    one = kind()
    one.struct_size = ctypes.sizeof(kind)
    return one


def candidates(path=""):
    """The files to try, in this order: `path` (a file, or the folder of the library) alone if it is set; else the
    folder of this add-on; else whatever the system's loader finds."""
    if path:
        given = pathlib.Path(path).expanduser()
        return [str(given / SONAME if given.is_dir() else given)]
    beside = pathlib.Path(__file__).resolve().parent / SONAME
    return ([str(beside)] if beside.exists() else []) + [SONAME]


def load(path=""):
    """Loads the library. Raises FurrowError if no candidate is a Furrow library of a known version."""
    faults = []
    for name in candidates(path):
        try:
            library = ctypes.CDLL(name, use_errno=False)
            library.furrow_abi_version.restype = ctypes.c_uint32
            version = library.furrow_abi_version()
            if version in (0, 1):
                return _declare(library)
            faults.append(f"{name}: interface version {version}; this add-on needs 0 or 1")
        except (OSError, AttributeError) as error:  # no file, no library, or an older one without a function
            faults.append(f"{name}: {error}")
    raise FurrowError(f"cannot load {SONAME} ({'; '.join(faults)}); set its path in the preferences of the add-on, or "
                      "add its folder to LD_LIBRARY_PATH")


def _declare(library):
    """States the types of the functions, without which ctypes would cut pointers to 32 bits."""
    handle, text, u32 = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_uint32
    for name, arguments in {
            "furrow_open": [text, ctypes.POINTER(_Options), ctypes.POINTER(handle)],
            "furrow_poll": [handle, ctypes.c_int32],
            "furrow_get_info": [handle, ctypes.POINTER(_Info)],
            "furrow_last_error": [handle, ctypes.c_char_p, u32],
            "furrow_subscribe": [handle, ctypes.POINTER(_Subscription)],
            "furrow_unsubscribe": [handle, text],
            "furrow_subject_name": [handle, u32, ctypes.c_char_p, u32],
            "furrow_weights": [handle, text, ctypes.POINTER(ctypes.c_float), u32, ctypes.POINTER(_Frame)],
            "furrow_layout": [handle, text, ctypes.POINTER(u32), ctypes.POINTER(ctypes.c_uint64)],
            "furrow_weight_name": [handle, text, u32, ctypes.c_char_p, u32],
            "furrow_set_callbacks": [handle, ctypes.POINTER(_Callbacks)]}.items():
        function = getattr(library, name)
        function.argtypes, function.restype = arguments, ctypes.c_int
    library.furrow_close.argtypes, library.furrow_close.restype = [handle], None
    library.furrow_status_text.argtypes, library.furrow_status_text.restype = [ctypes.c_int], text
    library.furrow_version.argtypes, library.furrow_version.restype = [], text
    return library


class Frame:
    """The weights of one subject at one moment."""

    __slots__ = ("subject", "values", "sequence", "capture_time_us", "timecode", "decaying")

    def __init__(self, subject, values, sequence, capture_time_us, timecode, decaying):
        self.subject = subject  # the name that the daemon uses
        self.values = values  # in [0, 1], in the order of Connection.names()
        self.sequence = sequence  # of the pose; it wraps around at 2^32
        self.capture_time_us = capture_time_us  # of the pose, on the publisher's clock
        self.timecode = timecode  # SMPTE, of the pose: "10:00:00;00", with ';' if drop-frame; "": its source sends none
        self.decaying = decaying  # no new pose: the daemon holds, then fades to neutral


class State:
    """What is known of a subscription right now."""

    __slots__ = ("status", "text", "age_us", "missed", "gone", "decaying")

    def __init__(self, status, text, frame):
        self.status = status  # OK, NO_DATA or an error
        self.text = text  # one sentence for people
        self.age_us = frame.age_us  # time without a new pose, microseconds
        self.missed = frame.missed  # poses without a frame
        self.gone = bool(frame.flags & FRAME_SUBJECT_GONE)
        self.decaying = bool(frame.flags & FRAME_DECAYING)


class Connection:
    """A connection to a daemon. It reconnects by itself. Use it on one thread."""

    def __init__(self, library, address, program="furrow-blender"):
        """`address`: "furrow://host[:port][?transport=tcp]" or "host[:port]". Raises FurrowError."""
        self._library = library
        self._frames = []
        self._values = (ctypes.c_float * MAX_WEIGHTS)()
        self._handle = ctypes.c_void_p()
        error = ctypes.create_string_buffer(1024)
        options = _sized(_Options)
        options.flags = OPEN_WITHOUT_SUBSCRIPTION
        options.program = program.encode()
        options.error, options.error_size = ctypes.cast(error, ctypes.c_char_p), len(error)
        status = library.furrow_open(address.encode(), ctypes.byref(options), ctypes.byref(self._handle))
        if status < OK:
            raise FurrowError(error.value.decode("utf-8", "replace") or self.text(status))
        # The library keeps the pointers, so the objects live as long as the connection.
        self._callbacks = _sized(_Callbacks)
        self._callbacks.on_weights = _ON_WEIGHTS(self._on_weights)
        self._check(library.furrow_set_callbacks(self._handle, ctypes.byref(self._callbacks)))

    def close(self):
        """Ends the connection. Further calls of close() do nothing."""
        if self._handle:
            self._library.furrow_close(self._handle)
            self._handle = ctypes.c_void_p()

    def text(self, status):
        """One sentence for a status."""
        return self._library.furrow_status_text(status).decode()

    def last_error(self):
        """What the daemon or the network reported last; empty if nothing did."""
        buffer = ctypes.create_string_buffer(1024)
        self._library.furrow_last_error(self._handle, buffer, len(buffer))
        return buffer.value.decode("utf-8", "replace")

    def poll(self):
        """Does the work of the connection without waiting. Returns all frames that have arrived, oldest first."""
        self._check(self._library.furrow_poll(self._handle, 0))
        frames, self._frames = self._frames, []
        return frames

    def state(self):
        """CONNECTING, CONNECTED or DISCONNECTED."""
        info = _sized(_Info)
        self._check(self._library.furrow_get_info(self._handle, ctypes.byref(info)))
        return info.state

    def subscribe(self, subject):
        """Follows a subject; "" means the oldest one. Raises FurrowError, also for a second subscription."""
        request = _sized(_Subscription)
        request.subject = subject.encode()
        self._check(self._library.furrow_subscribe(self._handle, ctypes.byref(request)))

    def unsubscribe(self, subject):
        """`subject`: the name that was asked for."""
        self._check(self._library.furrow_unsubscribe(self._handle, subject.encode()))

    def subject_name(self, index):
        """The name that the daemon uses for subscription `index`, in the order of subscribing; "" while unknown."""
        buffer = ctypes.create_string_buffer(NAME_SIZE)
        self._check(self._library.furrow_subject_name(self._handle, index, buffer, len(buffer)))
        return buffer.value.decode("utf-8", "replace")

    def names(self, subject):
        """The names of the weights in their order; empty while they are unknown."""
        count, layout = ctypes.c_uint32(), ctypes.c_uint64()
        key = subject.encode()
        if self._library.furrow_layout(self._handle, key, ctypes.byref(count), ctypes.byref(layout)) != OK:
            return []
        buffer, names = ctypes.create_string_buffer(NAME_SIZE), []
        for index in range(count.value):
            self._check(self._library.furrow_weight_name(self._handle, key, index, buffer, len(buffer)))
            names.append(buffer.value.decode("utf-8", "replace"))
        return names

    def layout(self, subject):
        """A number that changes with the names; 0 while they are unknown."""
        layout = ctypes.c_uint64()
        status = self._library.furrow_layout(self._handle, subject.encode(), None, ctypes.byref(layout))
        return layout.value if status == OK else 0

    def subject_state(self, subject):
        """The State of a subscription."""
        frame = _sized(_Frame)
        status = self._library.furrow_weights(self._handle, subject.encode(), self._values, MAX_WEIGHTS,
                                              ctypes.byref(frame))
        text = self.text(status) if status in (OK, NO_DATA) else self.last_error() or self.text(status)
        return State(status, text, frame)

    def _on_weights(self, _user, subject, frame, values):
        # Runs inside furrow_poll(). An exception must not pass through C; nothing below raises one.
        one = frame.contents
        # An older library passes a shorter struct.
        timecode = one.timecode.decode("ascii", "replace") if one.struct_size >= ctypes.sizeof(_Frame) else ""
        self._frames.append(Frame(subject.decode("utf-8", "replace"), values[:one.count], one.sequence,
                                  one.capture_time_us, timecode, bool(one.flags & FRAME_DECAYING)))

    def _check(self, status):
        if status < OK:
            raise FurrowError(self.last_error() or self.text(status))
