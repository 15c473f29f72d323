#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the worked session of protocol/STANDARD.md (section 13). Written from the document alone.

    worked_session.py --check STANDARD.md VECTORS   check the document against the committed datagrams
    worked_session.py --print VECTORS               print the tables of the session, to paste into the document

The document shows every datagram as rows of "offset  bytes  meaning". The check proves for each datagram that
- the rows have no gaps, and their bytes equal the committed session_*.bin,
- decode.py accepts the bytes, and the fields are those of the committed session_*.json,
- every "meaning" is what this script reads at that offset with the tables of the document.
"""
import json
import re
import struct
import sys
from pathlib import Path

from decode import decode, equal
from messages import unpack_rotation

# The slots of the session's messages: sections 4 and 6 to 9. A number is its struct format.
STRING, STRINGS = "string", "[string]"
SLOTS = {
    b"FHEL": [("client", STRING), ("token", "Q"), ("padding", "[B]"), ("bundles", "?"),
              ("access", STRING)],
    b"FWEL": [("server", STRING), ("token", "Q"), ("others", STRINGS)],
    b"FBYE": [("reason", "B")],
    b"FSKO": [("subject", STRING), ("skeleton_hash", "Q"), ("metres_per_unit", "f"), ("names", STRINGS),
              ("parents", "[h]"), ("rest_translations", "[3f]"), ("rest_rotations", "[4f]"),
              ("rest_scales", "[3f]"), ("tail_mask", "[B]"), ("tails", "[3f]"), ("blend_shape_names", STRINGS)],
    b"FSKR": [("skeleton_hash", "Q"), ("status", "B"), ("message", STRING)],
    b"FPOS": [("skeleton_hash", "Q"), ("num_joints", "H"), ("num_blend_shapes", "H"), ("partial", "?"),
              ("rotation_mask", "[B]"), ("rotations", "[4f]"), ("packed_rotations", "[3H]"),
              ("translation_mask", "[B]"), ("translations", "[3f]"), ("packed_translations", "[3h]"),
              ("translation_range", "f"), ("scale_mask", "[B]"), ("scales", "[3f]"), ("blend_shape_mask", "[B]"),
              ("blend_shapes", "[f]"), ("packed_blend_shapes", "[h]"), ("previous", "[B]"), ("previous_age_us", "I")],
    b"FSUW": [("subject", STRING), ("wait", "?"), ("pattern", STRING), ("max_rate_hz", "f"), ("format", "B"),
              ("source", "B"), ("every", "?")],
    b"FSUR": [("subject", STRING), ("names_hash", "Q"), ("names", STRINGS), ("publisher_session", "Q"),
              ("epoch", "Q")],
    b"FWGT": [("names_hash", "Q"), ("age_us", "q"), ("values", "[f]"), ("packed_values", "[B]")],
}
ENVELOPE = [(0, "4s", "magic"), (4, "B", "version"), (5, "B", "flags"), (6, "H", "stream"), (8, "Q", "session"),
            (16, "I", "sequence"), (20, "I", "payload size"), (24, "q", "capture time, microseconds")]


def shown(value):
    """A number as the document writes it: floats in their shortest form, wide integers in hexadecimal."""
    if isinstance(value, bytes):
        return json.dumps(value.decode("utf-8"), ensure_ascii=False)
    if isinstance(value, float):
        return f"{value:.9g}"
    return f"0x{value:016x}" if not isinstance(value, bool) and value >= 2**32 else str(value).lower()


class Annotator:
    """Names every byte of one datagram. Offsets count from the beginning of the datagram."""

    def __init__(self, data):
        self.data, self.rows = data, {}

    def read(self, offset, layout):
        return struct.unpack_from("<" + layout, self.data, offset)

    def row(self, offset, layout, meaning):
        self.rows[offset] = (struct.calcsize("<" + layout), meaning)
        return self.read(offset, layout)[0]

    def value(self, offset, layout, name):
        values = self.read(offset, layout)
        meaning = f"{name}: {', '.join(map(shown, values))}"
        if name.startswith("packed_rotations"):
            meaning += f" = rotation {', '.join(f'{c + 0:.4g}' for c in unpack_rotation(values))}"
        if name.startswith("packed_values"):
            meaning += f" = {values[0] / 255:.4g}"
        self.row(offset, layout, meaning)

    def string(self, offset, name):
        count = self.row(offset, "I", f"length of {name}")
        self.rows[offset + 4] = (count, f"{name}: {shown(self.data[offset + 4:offset + 4 + count])}")
        self.rows[offset + 4 + count] = (1, "zero byte behind the string")

    def vector(self, offset, element, name):
        count = self.row(offset, "I", f"number of elements in {name}")
        size = struct.calcsize("<" + element)
        begin = offset + 4
        if not any(self.data[begin:begin + count * size]) and count * size > 16:
            self.rows[begin] = (count * size, f"{name}: all 0")
            return
        for i in range(count):
            self.value(begin + i * size, element, f"{name}[{i}]")

    def strings(self, offset, name):
        count = self.row(offset, "I", f"number of elements in {name}")
        for i in range(count):
            place = offset + 4 + 4 * i
            self.string(place + self.row(place, "I", f"offset to {name}[{i}]"), f"{name}[{i}]")

    def field(self, place, name, kind):
        if not kind.startswith("[") and kind != STRING:
            self.value(place, kind, name)
            return
        target = place + self.row(place, "I", f"offset to {name}")
        if kind == STRING:
            self.string(target, name)
        elif kind == STRINGS:
            self.strings(target, name)
        else:
            self.vector(target, kind[1:-1], name)

    def table(self, position, slots):
        vtable = position - self.row(position, "i", "table: distance back to its vtable")
        size = self.row(vtable, "H", "vtable: its size in bytes")
        self.row(vtable + 2, "H", "size of the table in bytes")
        for slot in range((size - 4) // 2):
            entry = vtable + 4 + 2 * slot
            name, kind = slots[slot]
            (offset,) = self.read(entry, "H")
            state = f"at table + {offset}" if offset else "absent"
            self.row(entry, "H", f"slot {slot}, {name}: {state}")
            if offset:
                self.field(position + offset, name, kind)

    def annotate(self):
        for offset, layout, name in ENVELOPE:
            self.value(offset, layout, name)
        root = 32 + self.row(32, "I", "offset to the root table")
        self.value(36, "4s", "file identifier")
        self.table(root, SLOTS[self.data[36:40]])
        return list(self.with_padding())

    def with_padding(self):
        end = 0
        for offset, (size, meaning) in sorted(self.rows.items()):
            assert offset >= end, f"rows overlap at {offset}"
            if offset > end:
                yield end, self.data[end:offset], "alignment"
            if size > 0:
                yield offset, self.data[offset:offset + size], meaning
            end = offset + size
        if end < len(self.data):
            yield end, self.data[end:], "alignment"


def hexadecimal(data):
    """Bytes as the document shows them. Long runs of zeros are abbreviated."""
    if len(data) > 16 and not any(data):
        return f"00 * {len(data)}"
    return data.hex(" ")


def formatted(data):
    rows = [(str(offset), hexadecimal(part), meaning) for offset, part, meaning in Annotator(data).annotate()]
    width = max(len(row[1]) for row in rows)
    return "".join(f"{offset:>4}  {part:<{width}}  {meaning}\n" for offset, part, meaning in rows)


ROW = re.compile(r"^ *(\d+)  (00 \* \d+|(?:[0-9a-f]{2} )*[0-9a-f]{2}) +(\S.*)$")


def parse(block):
    """Rows of the document -> the bytes of the datagram and [(offset, meaning)]."""
    data, meanings = b"", []
    for line in block.splitlines():
        match = ROW.match(line)
        assert match, f"not a row: {line!r}"
        offset, part, meaning = int(match.group(1)), match.group(2), match.group(3)
        assert offset == len(data), f"a row at {offset}, but the bytes before it end at {len(data)}"
        data += bytes(int(part.split("*")[1])) if "*" in part else bytes.fromhex(part)
        meanings.append((offset, meaning))
    return data, meanings


def fault_of(block, vector):
    """None, or what is wrong with the rows of one datagram."""
    data, meanings = parse(block)
    if data != vector.read_bytes():
        return "the bytes differ from the committed datagram"
    expected = json.loads(vector.with_suffix(".json").read_text(encoding="utf-8"))
    expected.pop("container")
    if not equal(expected, decode(data)):
        return f"decoded as {json.dumps(decode(data))}"
    for stated, (offset, _, meaning) in zip(meanings, Annotator(data).annotate()):
        if stated != (offset, meaning):
            return f"the document says {stated}, the bytes say {(offset, meaning)}"
    return None


def check(document, folder):
    text = Path(document).read_text(encoding="utf-8")
    section = text[text.index("## 13. A worked session"):]
    blocks = dict(re.findall(r"<!-- (session_\w+) -->\n+```text\n(.*?)```", section, re.S))
    vectors = {path.stem: path for path in sorted(Path(folder).glob("session_*.bin"))}
    faults = [f"{name}: missing in the document" for name in vectors.keys() - blocks.keys()]
    faults += [f"{name}: not a committed datagram" for name in blocks.keys() - vectors.keys()]
    faults += [f"{name}: {fault}" for name in blocks.keys() & vectors.keys()
               if (fault := fault_of(blocks[name], vectors[name]))]
    for fault in sorted(faults):
        print(fault, file=sys.stderr)
    print(f"{len(blocks)} datagrams in the document, {len(faults)} faults")
    return 1 if faults or not blocks else 0


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "--check":
        return check(*arguments[1:])
    if len(arguments) == 2 and arguments[0] == "--print":
        for path in sorted(Path(arguments[1]).glob("session_*.bin")):
            print(f"<!-- {path.stem} -->\n```text\n{formatted(path.read_bytes())}```\n")
        return 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
