#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Weights as OSC, read by liblo's oscdump: targets of the configuration, and targets over HTTP."""
import contextlib
import http.client
import json
import pathlib
import re
import select
import shutil
import socket
import subprocess
import tempfile
import unittest

from furrow_testing import BIN, GUARD, SHARE, Daemon, free_port, spawn
from wire_testing import Api

PERFORMANCE = SHARE / "recordings" / "performance.bvh"


@unittest.skipUnless(shutil.which("oscdump") and shutil.which("stdbuf"), "liblo-tools is not installed")
class OscTest(unittest.TestCase):
    def dump(self):
        """Starts oscdump. Returns its port and a function that reads a line: address, tags, values."""
        port = free_port(socket.SOCK_DGRAM)
        process = subprocess.Popen(["stdbuf", "-oL", "oscdump", "-L", str(port)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait, timeout=GUARD)
        self.addCleanup(process.kill)

        def read():
            while True:
                line = process.stdout.readline()
                assert line, "oscdump ended"
                words = line.split()[1:]  # without the time
                if words[0] != "/ready":
                    return words

        # Until oscdump listens, the daemon would count errors.
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.connect(("127.0.0.1", port))
            while not select.select([process.stdout], [], [], 0.05)[0]:
                with contextlib.suppress(ConnectionRefusedError):
                    probe.send(b"/ready\0\0,\0\0\0")
        return port, read

    def play(self, daemon, *subjects):
        for subject in subjects:
            player = spawn("play", PERFORMANCE, "--to", daemon.udp, "--subject", subject, "--rate", 60,
                           "--loop")
            self.addCleanup(player.stdout.close)
            self.addCleanup(player.stderr.close)
            self.addCleanup(player.wait, timeout=GUARD)
            self.addCleanup(player.terminate)

    def config(self, text):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-osc-"))
        self.addCleanup(shutil.rmtree, folder)
        (folder / "furrow.toml").write_text(text)
        return folder

    def test_targets_of_the_configuration(self):
        vmc, read_vmc = self.dump()
        own, read_own = self.dump()
        folder = self.config(f"""
[[osc.target]]
to = "127.0.0.1:{vmc}"
profile = "vmc"
subject = "bob"

[[osc.target]]
to = "127.0.0.1:{own}"
profile = "mine.toml"
pattern = "brow_l.squash"
rate_hz = 20
""")
        (folder / "mine.toml").write_text('[value]\naddress = "/{subject}/face"\narguments = ["name", "value", "sequence"]\n'
                                          '[names]\n"brow_l.squash" = "BrowDownLeft"\n')
        with Daemon("--config", folder / "furrow.toml", "--no-render", "--http", 0) as daemon:
            self.play(daemon, "ada", "bob")
            while read_vmc()[0] != "/VMC/Ext/Blend/Apply":
                pass
            frame = {}
            line = read_vmc()
            while line[0] == "/VMC/Ext/Blend/Val":
                self.assertEqual(line[1], "sf")
                frame[line[2].strip('"')] = float(line[3])
                line = read_vmc()
            self.assertEqual(line[0], "/VMC/Ext/Blend/Apply")
            self.assertGreater(len(frame), 50)
            self.assertTrue(all(0 <= value <= 1 for value in frame.values()))
            heard = {"/ada/face": [], "/bob/face": []}
            while min(map(len, heard.values())) < 6:
                address, tags, name, _, sequence = read_own()
                self.assertEqual((tags, name), ("sfi", '"BrowDownLeft"'))
                heard[address].append(int(sequence))
            for sequences in heard.values():
                # 20 of 60 poses per second.
                self.assertGreaterEqual(sequences[5] - sequences[0], 10)
            listed = Api(daemon).get("/api/osc")["targets"]
            self.assertEqual([(t["profile"], t["configured"]) for t in listed],
                             [("vmc", True), (str(folder / "mine.toml"), True)])

    def test_targets_over_http(self):
        port, read = self.dump()
        with Daemon("--no-render", "--http", 0) as daemon:
            api = Api(daemon)
            self.play(daemon, "ada")
            self.assertEqual(api.get("/api/osc"), {"targets": [], "profiles": ["furrow", "vmc", "vrchat"], "allow": []})
            reply = api.post("/api/osc", {"to": f"127.0.0.1:{port}", "profile": "vrchat", "pattern": "brow_*"})
            target = reply["targets"][0]
            for _ in range(20):
                address, tags, value = read()
                self.assertRegex(address, r"^/avatar/parameters/furrow_brow_\w+$")
                self.assertEqual(tags, "f")
                self.assertTrue(0 <= float(value) <= 1)
            sent = api.get("/api/osc")["targets"][0]
            self.assertGreater(sent["packets"], 0)
            self.assertEqual((sent["errors"], sent["last_error"]), (0, ""))
            metrics = api.bytes("GET", "/metrics")[1].decode()
            self.assertGreater(int(re.search(r"^furrow_osc_packets_sent_total (\d+)", metrics, re.M)[1]), 0)
            status, body = api.bytes("DELETE", "/api/osc", id=target["id"])
            self.assertEqual((status, json.loads(body)["targets"]), (200, []))
            self.assertEqual(api.bytes("DELETE", "/api/osc", id=target["id"])[0], 404)
            # A target that nobody reads: the error is shown.
            api.post("/api/osc", {"to": f"127.0.0.1:{free_port(socket.SOCK_DGRAM)}"})
            view = api.get("/api/osc")["targets"][0]
            while view["errors"] == 0:
                view = api.get("/api/osc")["targets"][0]
            self.assertIn("refused", view["last_error"])

    def test_nobody_can_aim_the_daemon_at_others(self):
        folder = self.config('[osc]\nallow = ["192.0.2.7"]\n')
        with Daemon("--config", folder / "furrow.toml", "--no-render", "--http", 0, "--vmc", 0) as daemon:
            api = Api(daemon)

            def refusal(body, headers=None):
                connection = http.client.HTTPConnection("127.0.0.1", daemon.ports["http"], timeout=GUARD)
                connection.request("POST", "/api/osc", json.dumps(body), headers or {})
                reply = connection.getresponse()
                error = json.loads(reply.read())["error"]
                connection.close()
                return reply.status, error["field"], error["message"]

            status, field, message = refusal({"to": "198.51.100.1:9000"})
            self.assertEqual((status, field), (403, "to"))
            self.assertIn("osc.allow", message)
            for port in (daemon.ports["udp"], daemon.ports["vmc"]):
                self.assertIn("belongs to this daemon", refusal({"to": f"127.0.0.1:{port}"})[2])
            for body, field in (({"to": "localhost:9000"}, "to"), ({}, "to"), ({"to": 7}, "to"), ({"too": "x"}, "too"),
                                ({"to": "127.0.0.1:9000", "rate_hz": "fast"}, "rate_hz"),
                                ({"to": "127.0.0.1:9000", "rate_hz": 1e9}, "rate_hz")):
                self.assertEqual(refusal(body)[:2], (400, field), body)
            self.assertEqual(refusal({"to": "127.0.0.1:9000", "profile": "../x.toml"})[:2], (404, "profile"))
            self.assertEqual(refusal({"to": "127.0.0.1:9000"}, {"Origin": "http://evil.example"})[0], 403)
            self.assertEqual(api.get("/api/osc")["targets"], [])

    def test_mistakes_in_the_configuration(self):
        for text, message in (
                ('[[osc.target]]\nprofile = "vmc"\n', ":1: osc.target number 1: needs the key 'to'"),
                ('[[osc.target]]\nto = "127.0.0.1:9000"\nspeed = 1\n', "number 1: has the unknown key 'speed'"),
                ('[[osc.target]]\nto = "127.0.0.1:9000"\nrate_hz = -1\n', "osc.target: rate_hz must be 0 to 1000"),
                ('[[osc.target]]\nto = "127.0.0.1:9000"\nprofile = "vmcc"\n', "shipped profiles: furrow, vmc, vrchat"),
                ('[osc]\nallow = ["stage"]\n', "osc.allow: 'stage' is not a numeric address")):
            folder = self.config(text)
            done = subprocess.run([BIN / "furrowd", "--config", folder / "furrow.toml", "--no-render", "--no-http", "--tcp",
                                   "0", "--udp", "0"], capture_output=True, text=True, timeout=GUARD, check=False)
            self.assertIn(message, done.stdout + done.stderr)
            self.assertEqual(done.returncode, 3, text)


if __name__ == "__main__":
    unittest.main()
