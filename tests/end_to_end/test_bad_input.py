#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bad input gives one clear message and the right exit code, and harms nothing else."""
import json
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest

from furrow_testing import (BIN, GUARD, SHARE, SOURCE, Daemon, Table, finish, free_port, furrow, solve, spawn_watch,
                            worst_difference)

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
RIG = SHARE / "default.rig.json"
BVH = """HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -1 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -1 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333
0 0 0 0 0 0 0 0 0
0 0 0 0 0 0 0 10 0
"""
KNEE_RIG = {"name": "knee", "drivers": [{"name": "knee", "hinge": {"parent": "hips", "joint": "knee"}}]}

DONE, FAILED, USAGE, BAD_INPUT, NO_CONNECTION = range(5)


class BadFileTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)

    def file(self, name, text):
        path = self.root / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def check(self, text):
        """What `furrowd --check` says of a configuration: exit code, stdout, stderr."""
        done = subprocess.run([BIN / "furrowd", "--config", self.file("furrow.toml", text), "--check"],
                              capture_output=True, text=True, timeout=GUARD, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_a_configuration_is_checked_without_a_start(self):
        self.assertEqual(self.check("[render]\nenabled = false\n")[:2], (DONE, "the configuration is valid\n"))
        # Root may read more than a service.
        has_more_rights = os.geteuid() == 0 and os.path.isdir("/run/systemd/system")
        says = self.assertRegex if has_more_rights else self.assertNotRegex
        says(self.check("[render]\nenabled = false\n")[2],
             "checked as root.*: systemd-run .*User=furrowd .*--config /.*/furrow.toml --check\n")
        self.file("cut.bvh", BVH[:BVH.index("MOTION")])
        for text, fault in (("play = 'cut.bvh'\n", "cut.bvh"),
                            ("play = 'absent.bvh'\n", "absent.bvh"),
                            ("[listen]\ntpc = 1\n", "unknown key 'listen.tpc'"),
                            ("rig = 'nosuch'\n", "nosuch"),
                            ("[security]\nmode = 'required'\nkeys = 'absent'\n", "security.keys: ")):
            with self.subTest(text):
                code, out, errors = self.check(text)
                self.assertEqual((code, out), (BAD_INPUT, ""), errors)
                self.assertIn(fault, errors)
        # What systemd copies, beside a file that it does not.
        code, out, errors = self.check("[security]\nmode = 'required'\nkeys = 'absent'\n[tls]\n"
                                       "certificate = '/run/credentials/no.service/crt'\nkey = 'other.key'\n")
        self.assertEqual((code, out), (BAD_INPUT, ""), errors)
        self.assertIn("security.keys: ", errors)
        self.assertRegex(errors, "not checked, .*: /run/credentials/no.service/crt, .*other.key")
        code, out, errors = self.check("[security]\nmode = 'required'\nkeys = '/run/credentials/no.service/keys'\n")
        self.assertEqual((code, out), (DONE, "the configuration is valid\n"), errors)
        self.assertIn("not checked, because systemd copies them when it starts the service: /run/credentials/no.service/keys", errors)

    def test_a_fault_is_an_object_for_log_collectors(self):
        config = self.file("furrow.toml", "[listen]\ntpc = 1\n")
        done = subprocess.run([BIN / "furrowd", "--config", config, "--log-json"],
                              capture_output=True, text=True, timeout=GUARD, check=False)
        self.assertEqual((done.returncode, done.stdout), (BAD_INPUT, ""), done.stderr)
        line = json.loads(done.stderr)
        self.assertEqual(line["level"], "error")
        self.assertIn("furrow.toml:2: unknown key 'listen.tpc'", line["message"])

    def test_the_folders_of_the_configuration_are_checked(self):
        self.file("takes", "a file, not a folder")
        code, out, errors = self.check("[record]\ndir = 'takes'\n")
        self.assertEqual((code, out), (FAILED, ""), errors)
        self.assertRegex(errors, "record.dir: .*takes: .*is not a folder")
        code, out, errors = self.check("[record]\ndir = 'new/takes'\n[http]\npage = 'nowhere'\n")
        self.assertEqual((code, out), (DONE, "the configuration is valid\n"), errors)
        self.assertRegex(errors, "http.page: .*nowhere/index.html does not exist")
        self.assertFalse((self.root / "new").exists())

    def refuse(self, code, *args, says=()):
        """`furrow ARGS` must exit with `code` and a short message that contains each of `says`."""
        result = furrow(*args)
        message = result.stderr.decode()
        self.assertEqual(result.returncode, code, message)
        for text in says:
            self.assertIn(text, message)
        self.assertLessEqual(message.count("\n"), 3, message)
        return message

    def test_truncated_bvh(self):
        for end in (0, 10, BVH.index("JOINT"), BVH.index("MOTION"), BVH.index("10 0\n")):
            path = self.file("cut.bvh", BVH[:end])
            self.refuse(BAD_INPUT, "solve", path, "--rig", RIG, says=["cut.bvh"])

    def test_bvh_with_fewer_frames_than_declared_is_a_warning(self):
        path = self.file("few.bvh", BVH[:BVH.index("0 0 0 0 0 0 0 10 0")])
        result = furrow("solve", path, "--rig", self.file("knee.json", json.dumps(KNEE_RIG)), "--drivers", check=DONE)
        self.assertIn("few.bvh", result.stderr.decode())
        self.assertEqual(result.stdout.decode().count("\n"), 2)

    def test_wrong_channel_count_names_the_line(self):
        line = BVH.count("\n")
        path = self.file("short.bvh", BVH.replace("0 0 0 0 0 0 0 10 0", "0 0 0 0 0 0 0 10"))
        self.refuse(BAD_INPUT, "solve", path, "--rig", RIG, says=[f"short.bvh:{line}"])

    def test_nan_names_the_line(self):
        path = self.file("nan.bvh", BVH.replace("10 0\n", "nan 0\n"))
        self.refuse(BAD_INPUT, "solve", path, "--rig", RIG, says=[f"nan.bvh:{BVH.count(chr(10))}"])

    def test_rig_with_an_unknown_joint(self):
        rig = json.loads(json.dumps(KNEE_RIG))
        rig["drivers"][0]["hinge"]["joint"] = "elbow_of_nobody"
        self.refuse(BAD_INPUT, "solve", self.file("ok.bvh", BVH), "--rig", self.file("r.json", json.dumps(rig)),
                    says=["elbow_of_nobody", "knee"])

    def test_rig_with_an_unknown_field_names_file_line_and_field(self):
        rig = '{\n "name": "x",\n "drivrs": []\n}\n'
        self.refuse(BAD_INPUT, "rig", "check", self.file("typo.json", rig), says=["typo.json:3", "drivrs"])

    def test_glb_of_no_bytes(self):
        self.refuse(BAD_INPUT, "render", PERFORMANCE, "--out", self.root / "out", "--character",
                    self.file("empty.glb", b""), says=["empty.glb"])
        self.assertFalse((self.root / "out").exists())
        self.refuse(BAD_INPUT, "convert", self.root / "empty.glb", self.root / "out.bvh", says=["empty.glb"])

    def test_folders_are_bad_input(self):
        for name in ("folder.bvh", "folder.mcap", "folder.glb", "folder.json"):
            (self.root / name).mkdir()
        for args in (("info", self.root / "folder.bvh"), ("info", self.root / "folder.mcap"),
                     ("rig", "check", self.root / "folder.json"), ("shape-map", "check", self.root / "folder.json"),
                     ("solve", PERFORMANCE, "--rig", self.root / "folder.json"),
                     ("character", "check", self.root / "folder.glb")):
            with self.subTest(args):
                self.refuse(BAD_INPUT, *args, says=[f"{args[-1]}: is a folder (name a file in it)"])

    def test_cyclic_skeleton(self):
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"name": "a", "children": [1]}, {"name": "b", "children": [0]}],
                "skins": [{"joints": [0, 1]}],
                "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                                "samplers": [{"input": 0, "output": 1}]}],
                "buffers": [{"byteLength": 20}],
                "bufferViews": [{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 16}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR", "min": [0],
                               "max": [0]},
                              {"bufferView": 1, "componentType": 5126, "count": 1, "type": "VEC4"}]}
        text = json.dumps(gltf).encode()
        text += b" " * (-len(text) % 4)
        data = struct.pack("<5f", 0, 0, 0, 0, 1)
        glb = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
        glb += struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        path = self.file("ring.glb", glb)
        self.refuse(BAD_INPUT, "solve", path, "--rig", RIG, says=["ring.glb"])

    def test_missing_files_and_wrong_usage(self):
        self.refuse(BAD_INPUT, "solve", self.root / "no.bvh", "--rig", RIG, says=["no.bvh"])
        self.refuse(BAD_INPUT, "solve", self.file("ok.bvh", BVH), "--rig", self.root / "no.json", says=["no.json"])
        for args in ((), ("solve",), ("dance",), ("render", "x.bvh", "--out", "y", "--size", "9x9"),
                     ("render", "x.bvh", "--out", "y", "--frames", "5:"),
                     ("render", "x.bvh", "--out", "y", "--view", "inside"),
                     ("render", "x.bvh", "--out", "y", "--subjects", "257"),
                     ("play", "x.bvh", "--speed", "nan"), ("play", "x.bvh", "--from", "-nan"),
                     ("convert", "x.bvh", "y.bvh", "--scale", "nan"),
                     ("load", "localhost", "x.bvh", "--duration", "nan"),
                     ("load", "localhost", "x.bvh", "--loss", "nan"),
                     ("record", "localhost", "--out", "x.mcap", "--duration", "nan"),
                     ("render", "x.bvh", "--out", "y", "--spacing", "0"),
                     ("play", self.file("ok.bvh", BVH), "--to", "localhost:0x7"), ("watch", "localhost:99999")):
            self.assertEqual(furrow(*args).returncode, USAGE, args)
        self.refuse(BAD_INPUT, "render", self.file("ok.bvh", BVH), "--out", self.root / "out", "--rig",
                    self.file("r.json", json.dumps(KNEE_RIG)), "--frames", "0:2", says=["no frame 2", "ok.bvh"])

    def test_full_disk_behind_standard_output_is_reported(self):
        with open("/dev/full", "wb") as full:
            result = subprocess.run([BIN / "furrow", "solve", self.file("ok.bvh", BVH), "--rig",
                                     self.file("r.json", json.dumps(KNEE_RIG))], stdout=full,
                                    stderr=subprocess.PIPE, timeout=GUARD)
        self.assertEqual(result.returncode, FAILED)
        self.assertIn("No space left", result.stderr.decode())

    def test_name_that_is_not_utf8_is_rejected_before_it_is_sent(self):
        path = self.file("latin.bvh", BVH.replace("knee", "caf\u00e9").encode("latin-1"))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as nobody:
            nobody.bind(("127.0.0.1", 0))
            self.refuse(BAD_INPUT, "play", path, "--to", f"127.0.0.1:{nobody.getsockname()[1]}", says=["UTF-8"])

    def test_help_names_the_exit_codes(self):
        for program in ("furrow", "furrowd"):
            result = subprocess.run([BIN / program, "--help"], capture_output=True, timeout=GUARD, check=True)
            for word in ("Exit codes: 0", "2 wrong usage", "3 bad input"):
                self.assertIn(word, result.stdout.decode())


class DaemonTest(unittest.TestCase):
    def test_second_daemon_on_the_same_port(self):
        with Daemon("--no-render") as daemon:
            port = daemon.ports["tcp"]
            result = subprocess.run([BIN / "furrowd", "--no-render", "--tcp", str(port), "--udp", "0"],
                                    capture_output=True, timeout=GUARD)
            self.assertEqual(result.returncode, FAILED, result.stderr)
            self.assertIn(str(port), result.stderr.decode())

    def test_bad_files_stop_the_daemon_before_it_is_ready(self):
        with tempfile.TemporaryDirectory() as folder:
            empty = pathlib.Path(folder, "empty.glb")
            empty.write_bytes(b"")
            result = subprocess.run([BIN / "furrowd", "--character", empty, "--tcp", "0", "--udp", "0"],
                                    capture_output=True, timeout=GUARD)
            self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
            self.assertIn("empty.glb", result.stderr.decode())
            self.assertNotIn(b"ready", result.stdout)

    def test_subscriber_to_an_unknown_subject(self):
        with Daemon("--no-render") as daemon:
            for target, flags in ((daemon.tcp, ()), (daemon.udp, ("--udp",))):
                result = furrow("watch", target, "--subject", "nobody", *flags)
                self.assertEqual(result.returncode, FAILED)
                self.assertIn("nobody", result.stderr.decode())

    def test_closed_port(self):
        port = free_port()
        for args in (("watch", f"127.0.0.1:{port}"), ("watch", f"127.0.0.1:{port}", "--udp"),
                     ("play", PERFORMANCE, "--to", f"127.0.0.1:{port}", "--udp"),
                     ("play", PERFORMANCE, "--to", f"127.0.0.1:{port}", "--tcp")):
            self.assertEqual(furrow(*args).returncode, NO_CONNECTION, args)

    def test_unknown_host(self):
        host = "no-such-host.invalid"
        for args in (("watch", host), ("watch", host, "--udp"), ("play", PERFORMANCE, "--to", host),
                     ("frames", host, "--out", "-"), ("record", host, "--out", "none.mcap"), ("drain", host)):
            result = furrow(*args)
            self.assertEqual(result.returncode, NO_CONNECTION, (args, result.stderr))
            self.assertIn(f"furrow: no connection to {host}: no host of this name was found (check the name and the "
                          "network, or use a numeric address)\n", result.stderr.decode())

    def test_garbage_does_not_affect_a_stream(self):
        solved = solve(PERFORMANCE, "--rig", RIG)
        with Daemon("--no-render") as daemon:
            stop = threading.Event()
            sent = [0]

            def flood():
                """Sends up to 10,000 datagrams per second, of various sizes, some with the magic of the protocol."""
                rng = random.Random(1)
                out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
                out.connect(("127.0.0.1", daemon.ports["udp"]))
                start = time.monotonic()
                while not stop.is_set():
                    body = rng.randbytes(rng.choice((0, 1, 31, 32, 200, 1200, 1400)))
                    if rng.random() < 0.5:
                        body = b"FRRW\x01" + body
                    try:
                        out.send(body)
                    except OSError:
                        pass
                    sent[0] += 1
                    ahead = sent[0] / 10_000 - (time.monotonic() - start)
                    if ahead > 0:
                        stop.wait(ahead)
                out.close()

            thread = threading.Thread(target=flood)
            thread.start()
            watcher = spawn_watch(daemon.tcp, "ada")
            furrow("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", check=0)
            code, out, err = finish(watcher)
            stop.set()
            thread.join()
            self.assertEqual(code, 0, err)
            worst, frames = worst_difference(Table(out.decode()), solved)
            print(f"{sent[0]} garbage datagrams; {frames} of {len(solved.rows)} frames, worst {worst:.2e}")
            self.assertGreater(frames, 0)
            self.assertLess(worst, 1e-3)

    def test_interrupt_exits_with_0(self):
        with Daemon("--no-render") as daemon:
            daemon.process.send_signal(signal.SIGINT)
            self.assertEqual(daemon.process.wait(timeout=GUARD), 0)


if __name__ == "__main__":
    unittest.main()
