# SPDX-License-Identifier: Apache-2.0
"""The messages of protocol/STANDARD.md, sections 4 to 11: converts each table to a dictionary or raises Refused."""
import math
import struct

from flat_table import Table, require

# --- Section 5: masks, packed numbers; checks of section 11 --------------------------------------------


def masked(mask, n, values):
    """Returns the indices of the values."""
    if mask is None:
        require(len(values) in (0, n), "mask missing for a partial list")
        return list(range(len(values)))
    require(len(mask) == (n + 7) // 8, "wrong length of a mask")
    indices = [i for i in range(8 * len(mask)) if mask[i // 8] >> (i % 8) & 1]
    require(all(i < n for i in indices), "mask bits beyond the last item")
    require(len(indices) == len(values), "numbers of bits and values differ")
    return indices


def finite(values):
    for value in values:
        require(math.isfinite(value) and abs(value) <= 1e6, "number not finite or too large")
    return list(values)


def rotation(q):
    finite(q)
    require(abs(math.sqrt(sum(c * c for c in q)) - 1) <= 1e-3, "rotation not of unit length")
    return list(q)


def unpack_rotation(words):
    bits = words[0] | words[1] << 16 | words[2] << 32
    require(bits >> 47 == 0, "bit 47 of a packed rotation is set")
    codes = [bits >> shift & 0x7FFF for shift in (0, 15, 30)]
    require(all(code <= 32766 for code in codes), "32767 in a packed rotation")
    three = [(code / 32766 * 2 - 1) / math.sqrt(2) for code in codes]
    rest = 1 - sum(c * c for c in three)
    require(rest >= -1e-6, "length of a packed rotation above 1")
    three.insert(bits >> 45 & 3, math.sqrt(max(rest, 0)))
    return three


def unpack_offset(value, scale):
    require(value != -32768, "-32768 in packed numbers")
    return scale * value


def either(plain, packed):
    require(plain is None or packed is None, "both forms of one field")
    return plain or packed or []


def fnv1a(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return value


def hexadecimal(value):
    return f"0x{value:016x}"


def one_of(value, count):
    require(value < count, "unknown enumeration value")
    return value


# --- Messages, by file identifier ----------------------------------------------------------------------


def hello(t):
    return {"client": t.text(0, limit=64), "token": hexadecimal(t.scalar(1, "Q")),
            "bundles": t.flag(3), "access": t.text(4, limit=512)}


def welcome(t):
    fields = {"server": t.text(0, limit=64), "token": hexadecimal(t.scalar(1, "Q"))}
    others = t.texts(2)
    require(len(others) <= 8, "too many other servers")
    return {**fields, "others": others} if others else fields


def ping(t):
    return {"time_us": t.scalar(0, "q")}


def pong(t):
    return {"time_us": t.scalar(0, "q"), "server_time_us": t.scalar(1, "q")}


def goodbye(t):
    return {"reason": one_of(t.scalar(0, "B"), 4)}


def error(t):
    code = t.scalar(0, "H")
    require(1 <= code <= 16, "unknown error code")
    fields = {"code": code, "message": t.text(1, limit=1024)}
    host, tcp, udp = t.text(2), t.scalar(3, "H"), t.scalar(4, "H")
    require(host == "" or (tcp != 0 and udp != 0), "another server without ports")
    if not host:
        return fields
    web = {"web": t.scalar(5, "H"), "web_tls": t.flag(6)} if t.scalar(5, "H") else {}
    return {**fields, "host": host, "tcp": tcp, "udp": udp, **web}


def skeleton_offer(t):
    subject = t.text(0)
    require(subject != "", "no subject")
    names, shapes = t.texts(3), t.texts(10)
    count = len(names)
    require(count + len(shapes) > 0, "neither joints nor blend shapes")
    require(count <= 1024 and len(shapes) <= 512, "too many joints or blend shapes")
    parents = t.vector(4, "h") or []
    translations = t.vector(5, "3f") or []
    rotations = t.vector(6, "4f") or []
    scales = t.vector(7, "3f")
    scales = [[1.0, 1.0, 1.0]] * count if scales is None else scales
    require(all(len(v) == count for v in (parents, translations, rotations, scales)), "vectors of different lengths")
    tails = t.vector(9, "3f") or []
    tail_of = dict(zip(masked(t.vector(8, "B"), count, tails), tails))
    unit = t.scalar(2, "f", 1.0)
    require(finite([unit])[0] > 0, "metres_per_unit")
    joints, data = [], struct.pack("<H", count)
    for i in range(count):
        require(-1 <= parents[i] < i, "parent is not an earlier joint")
        joint = {"name": names[i], "parent": parents[i],
                 "rest_translation": finite(translations[i]),
                 "rest_rotation": rotation(rotations[i]), "rest_scale": finite(scales[i])}
        data += names[i].encode() + b"\0" + struct.pack(
            "<h10f", parents[i], *translations[i], *rotations[i], *scales[i])
        data += struct.pack("<H", i in tail_of)
        if i in tail_of:
            joint["tail"] = finite(tail_of[i])
            data += struct.pack("<3f", *tail_of[i])
        joints.append(joint)
    data += struct.pack("<fH", unit, len(shapes)) + b"".join(s.encode() + b"\0" for s in shapes)
    require(fnv1a(data) == t.scalar(1, "Q"), "wrong hash")
    return {"subject": subject, "skeleton_hash": hexadecimal(t.scalar(1, "Q")),
            "metres_per_unit": unit, "joints": joints, "blend_shape_names": shapes}


def skeleton_reply(t):
    return {"skeleton_hash": hexadecimal(t.scalar(0, "Q")), "status": one_of(t.scalar(1, "B"), 3),
            "message": t.text(2, limit=1024)}


def timecode(t, slot):
    """Section 5. Nothing for an absent or invalid one."""
    found = t.struct(slot, "IIHBB")
    if found is None:
        return {}
    frame, numerator, denominator, subframe, flags = found
    if numerator == 0 or denominator == 0:
        return {}
    rate, drops = -(-numerator // denominator), flags & 1
    if rate > 240 or (rate * denominator - numerator) * 500 > rate * denominator:
        return {}
    if drops and (rate not in (30, 60) or numerator % denominator == 0):
        return {}
    # Counts in tens of minutes: the first minute has all numbers, each of the other nine lacks some.
    skipped = rate // 15 if drops else 0
    tens, number = divmod(frame, 600 * rate - 9 * skipped)
    if tens >= 144:
        return {}
    for minute in range(1, 10):
        if number >= 60 * rate * minute:
            number += skipped
    seconds, frames = divmod(number + 600 * rate * tens, rate)
    text = "%02d:%02d:%02d%s%0*d" % (seconds // 3600, seconds // 60 % 60, seconds % 60, ";" if drops else ":",
                                     3 if rate > 100 else 2, frames)
    return {"timecode": {"frame": frame, "rate_numerator": numerator, "rate_denominator": denominator,
                         "subframe": subframe, "drop_frame": bool(drops), "text": text}}


def pose(t):
    joints, shapes = t.scalar(1, "H"), t.scalar(2, "H")
    require(joints <= 1024 and shapes <= 512, "too many joints or blend shapes")
    plain, packed = t.vector(5, "4f"), t.vector(6, "3H")
    either(plain, packed)
    rotations = [unpack_rotation(w) for w in packed] if packed else [rotation(q) for q in plain or []]
    plain, packed = t.vector(8, "3f"), t.vector(9, "3h")
    either(plain, packed)
    reach = finite([t.scalar(10, "f")])[0]
    require(reach >= 0, "negative range")
    translations = [[unpack_offset(c, reach / 32767) for c in v] for v in packed] if packed else [
        finite(v) for v in plain or []]
    scales = [finite(v) for v in t.vector(12, "3f") or []]
    plain, packed = t.vector(14, "f"), t.vector(15, "h")
    either(plain, packed)
    values = [unpack_offset(v, 1 / 16384) for v in packed] if packed else finite(plain or [])
    previous = t.vector(16, "B") or []
    require(len(previous) <= 1200, "previous pose too large")
    repeated = {"previous": list(previous), "previous_age_us": t.scalar(17, "I")} if previous else {}
    return {"skeleton_hash": hexadecimal(t.scalar(0, "Q")), "partial": t.flag(3), **repeated,
            "num_joints": joints, "num_blend_shapes": shapes,
            "rotation_joints": masked(t.vector(4, "B"), joints, rotations), "rotations": rotations,
            "translation_joints": masked(t.vector(7, "B"), joints, translations),
            "translations": translations,
            "scale_joints": masked(t.vector(11, "B"), joints, scales), "scales": scales,
            "blend_shape_indices": masked(t.vector(13, "B"), shapes, values), "blend_shapes": values, **timecode(t, 18)}


def rate(value):
    require(0 <= finite([value])[0] <= 1000, "rate out of range")
    return value


def subscribe_weights(t):
    return {"subject": t.text(0), "wait": t.flag(1), "pattern": t.text(2, "*", 4096),
            "max_rate_hz": rate(t.scalar(3, "f")), "format": one_of(t.scalar(4, "B"), 2),
            "source": one_of(t.scalar(5, "B"), 2), "every": t.flag(6)}


def subscribe_poses(t):
    return {"subject": t.text(0), "wait": t.flag(1), "max_rate_hz": rate(t.scalar(2, "f")),
            "every": t.flag(3)}


def subscribe_pictures(t):
    message = {"subject": t.text(0), "wait": t.flag(1), "width": t.scalar(2, "H", 640),
               "height": t.scalar(3, "H", 480), "max_rate_hz": rate(t.scalar(4, "f")),
               "format": one_of(t.scalar(5, "B"), 2), "quality": t.scalar(6, "B", 80),
               "view": t.text(7, "final"), "camera_preset": t.text(8)}
    require(16 <= message["width"] <= 4096 and 16 <= message["height"] <= 4096, "size out of range")
    require(1 <= message["quality"] <= 100, "quality out of range")
    camera = t.struct(9, "7f")
    if camera is not None:
        require(message["camera_preset"] == "", "both a camera and a preset")
        finite(camera)
        require(1 < camera[6] < 170, "field of view out of range")
        require(camera[0:3] != camera[3:6], "eye equals target")
        message.update(eye=camera[0:3], target=camera[3:6], vertical_fov_degrees=camera[6])
    settings = t.texts(11, unique=False)
    require(len(settings) <= 128 and "" not in settings, "too many settings or an empty setting")
    codecs = t.texts(13, unique=False)
    require(len(codecs) <= 8 and "" not in codecs, "too many codecs or an empty codec")
    require(all(len(c.encode()) <= 32 for c in codecs), "a codec is too long")
    message.update(acknowledged=t.flag(10), settings=settings, camera_follows=t.flag(12), codecs=codecs)
    return message


def update_pictures(t):
    place = t.target(0)
    require(place is not None, "no pictures")
    return subscribe_pictures(Table(t.data, place))


def frame_ack(t):
    require(t.scalar(0, "I") > 0, "number is 0")
    return {"number": t.scalar(0, "I"), "needs_key": t.flag(1), "held_us": t.scalar(2, "I")}


def unsubscribe(_):
    return {}


def subscribe_reply(t):
    names = t.texts(2)
    expected = fnv1a(b"".join(n.encode() + b"\0" for n in names)) if names else 0
    require(t.scalar(1, "Q") == expected, "wrong hash of the names")
    fields = {"subject": t.text(0), "names_hash": hexadecimal(expected), "names": names,
              "publisher_session": hexadecimal(t.scalar(3, "Q"))}
    epoch = t.scalar(4, "Q")
    return {**fields, "epoch": hexadecimal(epoch)} if epoch else fields


def age(value):
    require(value >= 0, "negative age")
    return value


def weights(t):
    plain, packed = t.vector(2, "f"), t.vector(3, "B")
    either(plain, packed)
    values = [v / 255 for v in packed] if packed is not None else finite(plain or [])
    require(all(0 <= v <= 1 for v in values), "weight out of range")
    return {"names_hash": hexadecimal(t.scalar(0, "Q")), "age_us": age(t.scalar(1, "q")),
            "format": 0 if packed is None else 1, "values": values, **timecode(t, 4)}


def dropped(t):
    return {"frames": t.scalar(0, "Q")}


def list_subjects(t):
    return {"follow": t.flag(0)}


def subjects(t):
    names, total = t.texts(0), t.scalar(1, "I")
    require(len(names) <= total and len(set(names)) == len(names), "more names than subjects, or a duplicate")
    return {"names": names, "total": total}


def numbers_between(values, count, least, most):
    require(len(finite(values)) == count and all(least <= v <= most for v in values), "wrong numbers of the filter")
    return list(values)


def subject_state(t):
    require(t.text(0) != "", "no subject")
    skeleton = t.scalar(1, "Q")

    def whole(slot):
        found = pose(Table(t.data, t.target(slot)))
        require(found["skeleton_hash"] == hexadecimal(skeleton) and not found["partial"] and "previous" not in found,
                "a pose that does not stand alone")
        return found

    filtered = t.vector(10, "f") or []
    require(len(filtered) <= 2048, "too many driver values")
    since = finite([t.scalar(13, "d", 0.0)])[0]
    require(since >= 0, "negative time")
    require(t.flag(4) == (t.place(6) is not None), "a pose is missing")
    fields = {"subject": t.text(0), "skeleton_hash": hexadecimal(skeleton), "publisher_session": hexadecimal(t.scalar(2, "Q")),
              "run": hexadecimal(t.scalar(3, "Q")), "newest_sequence": t.scalar(5, "I"), "values_hash": hexadecimal(t.scalar(8, "Q")),
              "num_drivers": t.scalar(9, "I"), "filtered": numbers_between(filtered, len(filtered), 0, 1),
              "inputs": numbers_between(t.vector(11, "f") or [], len(filtered), 0, 1),
              "speeds": numbers_between(t.vector(12, "f") or [], len(filtered), -1e6, 1e6),
              "since_input_s": since, "captures": t.text(14, limit=65536)}
    return {**fields, **{name: whole(slot) for name, slot in (("pose", 6), ("neutral", 7)) if t.place(slot) is not None}}


def drain(t):
    return {"begin": t.flag(0)}


def drain_state(t):
    names, left = t.texts(3), t.scalar(2, "I")
    require(len(names) <= min(left, 32), "more names than subjects")
    return {"draining": t.flag(0), "moved": t.scalar(1, "I"), "left": left, "names": names, "why": t.text(4, limit=1024)}


def image(t):
    data = t.vector(4, "B")
    require(data, "no bytes")
    width, height = t.scalar(0, "H"), t.scalar(1, "H")
    require(1 <= width <= 4096 and 1 <= height <= 4096, "size out of range")
    codec, key = t.text(11, limit=32), t.flag(12)
    require(not (key and codec == ""), "a key picture without a codec")
    require(not (t.flag(7) and codec != ""), "a still in a video codec")
    drawn = t.scalar(13, "B", 100)
    require(1 <= drawn <= 100, "drawn_percent out of range")
    return {"width": width, "height": height, "format": one_of(t.scalar(2, "B"), 2),
            "age_us": age(t.scalar(3, "q")), "bytes": data, "number": t.scalar(5, "I"),
            "tier": one_of(t.scalar(6, "B"), 3), "still": t.flag(7), "dropped": t.scalar(8, "I"),
            "received_us": t.scalar(9, "q"), "view_request": t.scalar(10, "I"), "codec": codec, "key": key,
            "drawn_percent": drawn}


KINDS = {b"FHEL": hello, b"FWEL": welcome, b"FPIN": ping, b"FPON": pong, b"FBYE": goodbye,
         b"FERR": error, b"FSKO": skeleton_offer, b"FSKR": skeleton_reply, b"FPOS": pose,
         b"FSUW": subscribe_weights, b"FSUP": subscribe_pictures, b"FUNS": unsubscribe,
         b"FSUR": subscribe_reply, b"FWGT": weights, b"FIMG": image, b"FUPP": update_pictures, b"FACK": frame_ack,
         b"FSPO": subscribe_poses, b"FDRP": dropped, b"FLSU": list_subjects, b"FSBJ": subjects,
         b"FSST": subject_state, b"FDRN": drain, b"FDRS": drain_state}
