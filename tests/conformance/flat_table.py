# SPDX-License-Identifier: Apache-2.0
"""Reads FlatBuffers (https://flatbuffers.dev/internals) and checks text as in section 11 of the standard."""
import struct


class Refused(Exception):
    """The bytes are not a message of this protocol."""


def require(condition, why):
    if not condition:
        raise Refused(why)


class Table:
    """One table. The vtable locates its slots; an absent slot has its default value."""

    def __init__(self, data, position):
        self.data, self.position = data, position
        self.vtable = position - self.number("<i", position)
        require(self.vtable >= 0, "vtable outside the buffer")
        self.vtable_bytes = self.number("<H", self.vtable)

    def number(self, layout, position):
        require(0 <= position and position + struct.calcsize(layout) <= len(self.data),
                "offset outside the buffer")
        return struct.unpack_from(layout, self.data, position)[0]

    def place(self, slot):
        entry = 4 + 2 * slot
        if entry + 2 > self.vtable_bytes:
            return None
        offset = self.number("<H", self.vtable + entry)
        return self.position + offset if offset else None

    def scalar(self, slot, layout, default=0):
        place = self.place(slot)
        return default if place is None else self.number("<" + layout, place)

    def flag(self, slot):
        return bool(self.scalar(slot, "B"))

    def target(self, slot):
        place = self.place(slot)
        return None if place is None else place + self.number("<I", place)

    def vector(self, slot, layout):
        """The elements of a vector of scalars or of structs of equal scalars. None if absent."""
        start = self.target(slot)
        if start is None:
            return None
        count, size = self.number("<I", start), struct.calcsize("<" + layout)
        require(start + 4 + count * size <= len(self.data), "vector outside the buffer")
        items = struct.iter_unpack("<" + layout, self.data[start + 4:start + 4 + count * size])
        return [item[0] if len(item) == 1 else list(item) for item in items]

    def text_at(self, start):
        count = self.number("<I", start)
        require(start + 4 + count <= len(self.data), "string outside the buffer")
        try:
            text = self.data[start + 4:start + 4 + count].decode("utf-8")
        except UnicodeDecodeError as error:
            raise Refused("text is not UTF-8") from error
        require(all(c >= " " and c != "\x7f" for c in text), "control characters in text")
        return text

    def text(self, slot, default="", limit=255):
        start = self.target(slot)
        text = default if start is None else self.text_at(start)
        require(len(text.encode()) <= limit, "text too long")
        return text

    def texts(self, slot, unique=True):
        start = self.target(slot)
        if start is None:
            return []
        places = [start + 4 + 4 * i for i in range(self.number("<I", start))]
        names = [self.text_at(place + self.number("<I", place)) for place in places]
        if unique:
            require(len(set(names)) == len(names) and "" not in names, "empty or duplicate name")
        return names

    def struct(self, slot, layout):
        place = self.place(slot)
        if place is None:
            return None
        require(place + struct.calcsize("<" + layout) <= len(self.data), "struct outside the buffer")
        return list(struct.unpack_from("<" + layout, self.data, place))
