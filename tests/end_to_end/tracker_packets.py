# SPDX-License-Identifier: Apache-2.0
"""The packets of face trackers: Live Link Face and VMC."""
import struct

# The order of the curves in a Live Link Face datagram.
CURVES = """EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft
EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight
JawForward JawLeft JawRight JawOpen MouthClose MouthFunnel MouthPucker MouthLeft MouthRight MouthSmileLeft
MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft MouthStretchRight
MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft
MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft
BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw HeadPitch
HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch RightEyeRoll""".split()


def livelink_face(subject, frame, shapes, rate=(60, 1)):
    """Returns one datagram of version 6. `rate`: frames per second, as a fraction."""
    device = b"12345678-1234-1234-1234-123456789ABC"
    name = subject.encode()
    packet = struct.pack(">B", 6)
    packet += struct.pack(">i", len(device)) + device + struct.pack(">i", len(name)) + name
    packet += struct.pack(">ifii", frame, 0.0, *rate)
    packet += struct.pack(">B61f", 61, *(shapes.get(curve, 0.0) for curve in CURVES))
    return packet


def livelink_csv(frames, curves=CURVES, hour=0):
    """Returns the CSV that Live Link Face records: one frame per map of curves, at 60 frames per second from `hour` on."""
    rows = ["Timecode,BlendShapeCount," + ",".join(curves)]
    for at, shapes in enumerate(frames):
        values = ",".join(str(shapes.get(curve, 0.0)) for curve in curves)
        rows.append(f"{hour:02}:00:{at // 60:02}:{at % 60:02}.000,{len(curves)},{values}")
    return "\n".join(rows) + "\n"


def osc(address, *values):
    """Returns an OSC message. Values are integers, floats or text."""
    def text(s):
        data = s.encode() + b"\0"
        return data + b"\0" * (-len(data) % 4)

    tags = {int: "i", float: "f", str: "s"}
    message = text(address) + text("," + "".join(tags[type(v)] for v in values))
    for value in values:
        message += text(value) if isinstance(value, str) else struct.pack(">" + tags[type(value)], value)
    return message


def vmc(expressions):
    """Returns the messages of one VMC frame."""
    yield osc("/VMC/Ext/OK", 1)
    for name, value in expressions.items():
        yield osc("/VMC/Ext/Blend/Val", name, float(value))
    yield osc("/VMC/Ext/Blend/Apply")
