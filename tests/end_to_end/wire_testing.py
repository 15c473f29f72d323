# SPDX-License-Identifier: Apache-2.0
"""Shared by the end-to-end tests: questions to a daemon over HTTP, and face trackers."""
import http.client
import json
import socket
import urllib.parse

from furrow_testing import GUARD
from tracker_packets import livelink_face


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
