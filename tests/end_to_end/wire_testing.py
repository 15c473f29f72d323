# SPDX-License-Identifier: Apache-2.0
"""Shared by the end-to-end tests: the packets of face trackers, and questions to a daemon over HTTP."""
import http.client
import json
import socket
import struct
import urllib.parse

from furrow_testing import GUARD

# The order of the curves in a Live Link Face datagram.
CURVES = """EyeBlinkLeft EyeLookDownLeft EyeLookInLeft EyeLookOutLeft EyeLookUpLeft EyeSquintLeft EyeWideLeft
EyeBlinkRight EyeLookDownRight EyeLookInRight EyeLookOutRight EyeLookUpRight EyeSquintRight EyeWideRight
JawForward JawLeft JawRight JawOpen MouthClose MouthFunnel MouthPucker MouthLeft MouthRight MouthSmileLeft
MouthSmileRight MouthFrownLeft MouthFrownRight MouthDimpleLeft MouthDimpleRight MouthStretchLeft MouthStretchRight
MouthRollLower MouthRollUpper MouthShrugLower MouthShrugUpper MouthPressLeft MouthPressRight MouthLowerDownLeft
MouthLowerDownRight MouthUpperUpLeft MouthUpperUpRight BrowDownLeft BrowDownRight BrowInnerUp BrowOuterUpLeft
BrowOuterUpRight CheekPuff CheekSquintLeft CheekSquintRight NoseSneerLeft NoseSneerRight TongueOut HeadYaw HeadPitch
HeadRoll LeftEyeYaw LeftEyePitch LeftEyeRoll RightEyeYaw RightEyePitch RightEyeRoll""".split()


def livelink_face(subject, frame, shapes):
    """Returns one datagram of version 6."""
    device = b"12345678-1234-1234-1234-123456789ABC"
    name = subject.encode()
    packet = struct.pack(">B", 6)
    packet += struct.pack(">i", len(device)) + device + struct.pack(">i", len(name)) + name
    packet += struct.pack(">ifii", frame, 0.0, 60, 1)
    packet += struct.pack(">B61f", 61, *(shapes.get(curve, 0.0) for curve in CURVES))
    return packet


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


class Api:
    """The HTTP API of a Daemon. Keeps one connection."""

    def __init__(self, daemon):
        self.connection = http.client.HTTPConnection("127.0.0.1", daemon.ports["http"], timeout=GUARD)

    def bytes(self, method, path, body=None, **query):
        """Returns the status and the body of a reply."""
        url = path + ("?" + urllib.parse.urlencode(query) if query else "")
        headers = {"Content-Type": "application/json"} if body is not None else {}
        self.connection.request(method, url, None if body is None else json.dumps(body), headers)
        reply = self.connection.getresponse()
        return reply.status, reply.read()

    def get(self, path, **query):
        status, body = self.bytes("GET", path, **query)
        assert status == 200, (path, query, status, body)
        return json.loads(body)

    def post(self, path, body):
        status, reply = self.bytes("POST", path, body)
        assert status == 200, (path, body, status, reply)
        return json.loads(reply)

    def snapshot(self, subject, **settings):
        """Returns a PNG of the subject. The first one may wait for shaders."""
        for _ in range(6):
            status, body = self.bytes("GET", "/snapshot.png", subject=subject, **settings)
            if status == 200:
                return body
        raise AssertionError((status, body))


class Tracker:
    """Sends the packets of a face tracker to a daemon until the daemon has solved them."""

    def __init__(self, daemon, port, subject=""):
        self.api = Api(daemon)
        self.target = ("127.0.0.1", daemon.ports[port])
        self.subject = subject
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.frame = 0

    def close(self):
        self.socket.close()
        self.api.connection.close()

    def poses(self):
        """The number of poses that the daemon has solved. The trackers of this class are alone."""
        return sum(subject["poses"] for subject in self.api.get("/api/subjects")["subjects"])

    def show(self, packets):
        """Sends `packets(frame)` in rising frames until two are solved, each before the next is sent: none is left waiting."""
        for _ in range(2):
            self.frame += 1
            before = self.poses()
            for packet in packets(self.frame):
                self.socket.sendto(packet, self.target)
            self.await_pose(before)

    def await_pose(self, before):
        for _ in range(20_000):
            if self.poses() > before:
                return
        raise AssertionError("the daemon solved no pose")


class Phone(Tracker):
    """An iPhone with Live Link Face."""

    def __init__(self, daemon):
        super().__init__(daemon, "livelink_face", "phone")

    def face(self, **shapes):
        self.show(lambda frame: [livelink_face(self.subject, frame, shapes)])

    def explain(self, weight):
        return self.api.get("/api/explain", subject=self.subject, weight=weight)
