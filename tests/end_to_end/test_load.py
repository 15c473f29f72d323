#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`furrow load` measures and checks, and classifies the faults that `furrow chaos` injects."""
import json
import pathlib
import re
import signal
import socket
import tempfile
import time
import unittest
import xml.etree.ElementTree

from furrow_testing import GUARD, SHARE, Daemon, commands, finish, furrow, make_certificate, spawn, spawn_watch

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
# Keeps the tests independent of the speed of the machine: only minutes count as late.
PATIENT = ["--late", "60000", "--drain", "5"]
UNKNOWN_HOST = ("furrow: no connection to no-such-host.invalid: no host of this name was found (check the name and the "
                "network, or use a numeric address)\n")


class Chaos:
    """Runs `furrow chaos` in front of a daemon in a with-block; `injected` holds its final counts."""

    def __init__(self, daemon=None, *args, to=None):
        listen = [] if "--listen" in args else ["--listen", "0"]
        target = [to] if to else [daemon.udp, "--to-tcp", str(daemon.ports["tcp"])]
        self.args = ["chaos", *listen, "--to", *target, *map(str, args)]

    def __enter__(self):
        self.process = spawn(*self.args)
        ready = self.process.stdout.readline().decode()
        assert ready.startswith("furrow chaos ready"), (ready, self.process.stderr.read().decode())
        self.ports = {name: int(port) for name, port in re.findall(r"(\w+)=[^ ]*?:(\d+)", ready)}
        self.udp = f"127.0.0.1:{self.ports['udp']}"
        self.tcp = f"127.0.0.1:{self.ports['tcp']}"
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        code, out, err = finish(self.process)
        assert code == 0, err
        self.injected = {}
        self.said = out.decode()
        for line in self.said.splitlines():
            way, _, what = line.partition(": ")
            self.injected[way] = {name: int(count) for name, count in re.findall(r"(\w+) (\d+)", what)}
            for name, count in re.findall(r"(\w+) \d+ \((\d+) with readable poses or weights\)", what):
                self.injected[way][name + " data"] = int(count)


class LoadTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def load(self, host, *args, patience=PATIENT):
        """Runs `furrow load`. Returns its JSON figures and its standard output."""
        figures = self.folder / "figures.json"
        result = furrow("load", host, PERFORMANCE, *patience, "--json", figures, *args)
        self.assertEqual(result.returncode, 0, (args, result.stdout.decode(), result.stderr.decode()))
        return json.loads(figures.read_text())["run"], result.stdout.decode()

    def test_a_correct_daemon_passes_over_every_path(self):
        with Daemon("--no-render") as daemon:
            for path, host, other in (("--udp", daemon.udp, "tcp"), ("--tcp", daemon.tcp, "udp"),
                                      ("--both", daemon.udp, "tcp")):
                run, text = self.load(host, "--subjects", "6", "--rate", "50", "--duration", "1", path,
                                      "--subscribers", "2", "--other-port", daemon.ports[other], "--strict")
                self.assertEqual(run["offered"], 300, path)
                self.assertEqual(run["expected"], 600, path)
                self.assertEqual(run["received"], 600, path)
                self.assertEqual(run["checked"], 600, path)
                self.assertEqual(run["wrong"] + run["lost"] + run["late"], 0, text)
                self.assertGreater(run["cpu_seconds"], 0, path)
                self.assertGreater(run["resident_bytes"], 1 << 20, path)
                self.assertLess(run["largest_difference"], 1e-5)
                self.assertIn("| offered | sent | expected | received | lost | late | wrong", text)

    def test_tls_reaches_the_daemon_directly_and_through_proxies(self):
        certificate, key = make_certificate(self.folder)
        short = ("--subjects", "4", "--rate", "50", "--duration", "1", "--strict")
        with Daemon("--no-render", "--tls-certificate", certificate, "--tls-key", key) as daemon:
            port = daemon.ports["tcp"]
            address = f"furrow://localhost:{port}?tls-authority={certificate}"
            other = ("--other-port", daemon.ports["udp"])
            run, _ = self.load(address, *short, *other)
            self.assertEqual(run["received"], 200)
            # Half of the connections over UDP, and subscribers that stall and churn over TLS.
            run, _ = self.load(address, *short, *other, "--both", "--stalled", "1", "--churn", "1")
            self.assertEqual(run["checked"], 200)
            # The proxy has another address than the certificate.
            run, _ = self.load(address, *short, *other, "--jitter", "2")
            self.assertEqual(run["received"], 200)
            with Chaos(to=f"furrow://localhost:{port}?tls=1") as chaos:
                through = f"furrow://localhost:{chaos.ports['tcp']}?tls-authority={certificate}"
                run, _ = self.load(through, *short)
                self.assertEqual(run["wrong"] + run["lost"], 0)
            self.assertRegex(chaos.said, r"up over TCP: \d+ connections")
            # Without the authority, and without TLS.
            result = furrow("load", f"furrow://localhost:{port}?tls=1", PERFORMANCE, "--duration", "1")
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("no known authority", result.stderr.decode())
            result = furrow("load", f"localhost:{port}", PERFORMANCE, "--tcp", "--duration", "1")
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("speaks TLS only", result.stderr.decode())

    def test_contradictions_about_tls_are_usage_errors(self):
        for args, message in ((("load", "furrow://a?tls=1", PERFORMANCE, "--udp"), "--udp: TLS needs TCP"),
                              (("load", "furrow://a?subject=b", PERFORMANCE), "names its subjects"),
                              (("chaos", "--listen", "0", "--to", "furrow://a?token=b"), "needs no token"),
                              (("chaos", "--listen", "0", "--to", "furrow://a?tls-authority=b"), "needs no files of TLS"),
                              (("chaos", "--listen", "0", "--to", "furrow://a?tls=1", "--to-tcp", "1"), "use one of both")):
            result = furrow(*args, check=2)
            self.assertIn(message, result.stderr.decode(), args)

    def test_jumps_of_the_capture_clocks_are_no_fault(self):
        with Daemon("--no-render") as daemon:
            run, _ = self.load(daemon.udp, "--subjects", "4", "--rate", "50", "--duration", "3", "--clock-step", "2.5",
                               "--clock-every", "0.7", "--strict")
        self.assertEqual(run["checked"], 600)

    def test_a_daemon_that_stood_still_decays_nobody(self):
        # The poses of the stall wait in the daemon's socket. Only the length of the stall matters, not any speed.
        figures = self.folder / "figures.json"
        with Daemon("--no-render") as daemon:
            watcher = spawn_watch(daemon.tcp, "load-000000", "--pattern", "brow_l.*")
            loader = spawn("load", daemon.udp, PERFORMANCE, *PATIENT, "--subjects", "4", "--rate", "50", "--duration", "4",
                           "--json", figures)
            for _ in range(3):  # the names, and two rows: poses flow
                self.assertTrue(watcher.stdout.readline())
            try:
                daemon.process.send_signal(signal.SIGSTOP)
                time.sleep(1.0)  # twice the time after which a silent subject decays
            finally:
                daemon.process.send_signal(signal.SIGCONT)
            code, _, err = finish(loader)
            self.assertEqual(code, 0, err)
            watcher.kill()
            watcher.communicate(timeout=GUARD)
        run = json.loads(figures.read_text())["run"]
        self.assertEqual(run["wrong"] + run["lost"], 0, run)
        self.assertIn("did not run for", daemon.stderr)
        if run["send_delay_max_us"] > 300_000:
            self.skipTest("the load generator stood still, too")
        self.assertEqual(run["aged"] + run["unchecked"], 0, run)

    def test_quantised_poses_are_checked_with_the_same_tolerance(self):
        with Daemon("--no-render") as daemon:
            run, _ = self.load(daemon.udp, "--subjects", "4", "--rate", "50", "--duration", "1", "--quantise",
                               "--strict")
            self.assertEqual(run["checked"], 200)
            self.assertLess(run["largest_difference"], 1e-4)

    def test_single_faults_among_ten_thousand_messages_are_found(self):
        # With this seed each fault occurs once among the first 1,502 datagrams. Weights that are ready together share
        # a datagram, so a busy machine sends fewer datagrams than weights.
        one = "0.0001"
        # With fewer weights, more of them share a datagram, and the first 1,502 last for the whole run.
        rig = json.loads(re.sub(r"^\s*//.*$", "", (SHARE / "default.rig.json").read_text(), flags=re.M))
        kept = ("stretch", "squash", "folds")
        for region in rig["regions"]:
            region["feeds"] = [feed for feed in region["feeds"] if feed["map"] in kept]
        rig["regions"] = [region for region in rig["regions"] if region["feeds"]]
        rig["wrinkle_maps"] = [wrinkle_map for wrinkle_map in rig["wrinkle_maps"] if wrinkle_map["name"] in kept]
        few = self.folder / "few.rig.json"
        few.write_text(json.dumps(rig))
        with Daemon("--no-render", "--rig", few) as daemon:
            chaos = Chaos(daemon, "--seed", "10491", "--way", "down", "--loss", one, "--falsify", one, "--swap", one,
                          "--delay", one, "--delay-by", "10000")
            with chaos:
                run, text = self.load(chaos.udp, "--subjects", "20", "--rate", "60", "--duration", "9",
                                      "--quantise", "--rig", few, patience=["--late", "5000", "--drain", "12"])
        self.assertEqual(run["offered"], 10800)
        injected = chaos.injected["down"]
        for fault in ("lost", "delayed", "falsified", "swapped"):
            self.assertGreater(injected[fault], 0, injected)
        # A fault may strike an answer to a ping or to a subscription instead of weights.
        self.assertGreaterEqual(run["late"], injected["delayed data"], text)
        self.assertLessEqual(run["late"], 20 * injected["delayed data"], text)
        self.assertEqual(run["falsified"], injected["falsified"], text)
        self.assertEqual(run["swapped"], injected["swapped"], text)
        # A slow machine may lose more, but never fewer.
        self.assertGreaterEqual(run["lost"], injected["lost data"], text)
        if run["lost"] > injected["lost data"]:
            print(f"this machine lost {run['lost'] - injected['lost data']} more")

    def test_falsified_poses_give_wrong_weights(self):
        # A packed pose of this recording takes one datagram, an unpacked pose two.
        for packing in ([], ["--floats"]):
            with Daemon("--no-render") as daemon, Chaos(daemon, "--way", "up", "--falsify", "0.05") as chaos:
                run, text = self.load(chaos.udp, "--subjects", "5", "--rate", "50", "--duration", "1", *packing)
            self.assertEqual(chaos.injected["up"].keys(), {"falsified"})
            self.assertGreater(chaos.injected["up"]["falsified"], 0)
            self.assertGreater(run["falsified"], 0, text)

    def test_faults_that_were_never_injected_are_reported(self):
        with Daemon("--no-render") as daemon:
            _, text = self.load(daemon.udp, "--subjects", "2", "--rate", "50", "--duration", "0.2", "--loss", "1e-9",
                                "--black-hole", "3600:1", "--other-port", daemon.ports["tcp"])
        self.assertIn("No fault was injected for --loss, --black-hole", text)

    def test_lost_messages_make_no_weight_wrong(self):
        with Daemon("--no-render") as daemon:
            run, text = self.load(daemon.udp, "--subjects", "10", "--rate", "50", "--duration", "2", "--quantise",
                                  "--seed", "5", "--loss", "0.05", "--reorder", "0.05", "--duplicate", "0.05",
                                  "--jitter", "3", "--other-port", daemon.ports["tcp"])
        self.assertGreater(run["lost"], 0, text)
        self.assertGreater(run["duplicates"], 0, text)
        self.assertEqual(run["wrong"], 0, text)
        self.assertIn("Injected faults, up:", text)
        # The JSON report contains the settings and the injected faults.
        written = json.loads((self.folder / "figures.json").read_text())
        settings, injected = written["settings"], written["planted"]
        self.assertEqual(settings["file"], str(PERFORMANCE))
        self.assertEqual([settings[key] for key in ("path", "subjects", "rate", "subscribers", "packing")],
                         ["udp", 10, 50.0, 1, "always"])
        for way in ("up", "down"):
            self.assertEqual(settings["chaos"][way]["seed"], 5)
            self.assertEqual(settings["chaos"][way]["loss"], 0.05)
            said = re.search(rf"Injected faults, {way}: (\d+) datagrams, lost (\d+)", text)
            self.assertEqual([injected[way]["datagrams"], injected[way]["lost"]], [int(n) for n in said.groups()])

    def test_misbehaving_subscribers_do_not_affect_the_others(self):
        with Daemon("--no-render") as daemon:
            run, text = self.load(daemon.udp, "--subjects", "5", "--rate", "50", "--duration", "2", "--stalled", "5",
                                  "--slow", "3", "--churn", "3", "--other-port", daemon.ports["tcp"], "--strict")
        self.assertEqual(run["received"], 500, text)
        self.assertGreater(run["churn_returns"], 0)
        self.assertRegex(text, f"reconnected {run['churn_returns']} times?[.]")

    def test_tcp_stalls_in_a_black_hole_and_loses_nothing(self):
        with Daemon("--no-render") as daemon, Chaos(daemon, "--black-hole", "0.5:0.3") as chaos:
            run, text = self.load(chaos.tcp, "--tcp", "--subjects", "2", "--rate", "50", "--duration", "1.5")
        # After the outage poses arrive in a burst, and a TCP subscriber may lose old frames.
        self.assertEqual(run["wrong"], 0, text)
        self.assertGreater(run["received"], 0, text)
        self.assertRegex(chaos.said, r"up over TCP: [1-9]\d* connections, [1-9]\d* bytes, .*stalled for [1-9]\d* ms")
        self.assertRegex(chaos.said, r"down over TCP: [1-9]\d* connections, [1-9]\d* bytes, .*stalled for [1-9]\d* ms")

    def test_a_daemon_with_another_rig_does_not_pass(self):
        with Daemon("--no-render", "--rig", SHARE / "rigs" / "arkit.json") as daemon:
            run, text = self.load(daemon.udp, "--subjects", "2", "--rate", "50", "--duration", "0.5")
            self.assertEqual(run["checked"], 0)
            self.assertIn("not checked", text)
            furrow("load", daemon.udp, PERFORMANCE, *PATIENT, "--duration", "0.2", "--strict", check=1)

    def test_histogram_and_plot_are_written(self):
        hgrm, svg = self.folder / "out.hgrm", self.folder / "out.svg"
        with Daemon("--no-render") as daemon:
            run, _ = self.load(daemon.udp, "--subjects", "3", "--rate", "50", "--duration", "1", "--hgrm", hgrm,
                               "--plot", svg)
        rows = [line.split() for line in hgrm.read_text().splitlines()[2:] if not line.startswith("#")]
        self.assertEqual(int(rows[-1][2]), run["received"])
        self.assertGreater(float(rows[0][0]), 0.0)
        self.assertEqual(run["early"], 0)
        self.assertAlmostEqual(float(rows[-1][0]) * 1000, run["latency_us"]["max"], delta=1.0)
        titles = "".join(xml.etree.ElementTree.parse(svg).getroot().itertext())
        self.assertIn("Latency by percentile", titles)
        self.assertIn("Latency over time", titles)

    def test_find_max_and_baseline_report_ratios_and_a_control(self):
        svg = self.folder / "out.svg"
        figures = self.folder / "figures.json"
        with Daemon("--no-render") as daemon:
            result = furrow("load", daemon.udp, PERFORMANCE, *PATIENT, "--find-max", "--baseline", "--subjects", "8",
                            "--rounds", "2", "--searches", "1", "--probe", "0.2", "--limit", "4000", "--duration",
                            "0.3", "--quantise", "--json", figures, "--plot", svg, check=0)
        comparison = json.loads(figures.read_text())["comparison"]
        named = {figure["name"]: figure for figure in comparison["figures"]}
        self.assertEqual(set(named), {"p50", "p90", "CPU a pose", "highest rate"})
        for figure in named.values():
            self.assertGreater(figure["ratio"]["median"], 0, figure)
            self.assertLessEqual(figure["control"]["low"], figure["control"]["high"], figure)
        self.assertIn("control, quartiles", result.stdout.decode())
        self.assertIn("Highest rate without loss", result.stdout.decode())
        self.assertIn("Loss by rate", "".join(xml.etree.ElementTree.parse(svg).getroot().itertext()))

    def test_ctrl_c_prints_the_run_so_far(self):
        with Daemon("--no-render") as daemon:
            process = spawn("load", daemon.udp, PERFORMANCE, "--duration", "3600")
            self.addCleanup(process.kill)
            furrow("watch", daemon.tcp, "--subject", "load-000000", "--wait", "--frames", "2", check=0)
            process.send_signal(signal.SIGINT)
            code, out, err = finish(process)
        self.assertEqual(code, 0, err)
        self.assertIn("so far", out.decode())
        self.assertRegex(out.decode(), r"\| [1-9]\d* +\| [1-9]\d* ")

    def test_strict_fails_for_lost_and_late_weights(self):
        short = [PERFORMANCE, "--subjects", "2", "--rate", "50", "--duration", "1", "--quantise", "--strict"]
        with Daemon("--no-render") as daemon:
            other = ["--other-port", daemon.ports["tcp"]]
            furrow("load", daemon.udp, *short, *other, "--late", "60000", "--drain", "0.5", "--loss", "0.2", check=1)
            furrow("load", daemon.udp, *short, *other, "--late", "0.001", "--drain", "5", check=1)
            furrow("load", daemon.udp, *short, *other, *PATIENT, check=0)

    def test_joints_that_the_recording_lacks_are_reported(self):
        def moving(joint):
            path = self.folder / f"{joint}.bvh"
            path.write_text(f"HIERARCHY\nROOT {joint}\n{{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n"
                            "{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.02\n0 0 0\n0 9 0\n")
            return path
        with Daemon("--no-render") as daemon:
            result = furrow("load", daemon.udp, moving("head"), "--duration", "0.2", *PATIENT, check=0)
            self.assertIn("warning: the recording lacks", result.stderr.decode())
            result = furrow("load", daemon.udp, moving("strange"), "--duration", "0.2", *PATIENT, check=3)
            self.assertIn("--skeleton-map", result.stderr.decode())

    def test_unwritable_outputs_are_reported_before_the_run(self):
        missing = self.folder / "missing" / "out"
        kept = self.folder / "kept.json"
        kept.write_text("kept")
        for flag in ("--json", "--hgrm", "--plot"):
            others = [] if flag == "--json" else ["--json", kept]
            result = furrow("load", "localhost:1", PERFORMANCE, *others, flag, missing, check=1)
            self.assertIn(str(missing), result.stderr.decode())
        self.assertEqual(kept.read_text(), "kept")

    def test_an_interrupted_comparison_is_written(self):
        figures, hgrm, svg = (self.folder / name for name in ("figures.json", "out.hgrm", "out.svg"))
        for how, code in ((signal.SIGINT, 0), (None, 4)):
            with Daemon("--no-render") as daemon:
                process = spawn("load", daemon.udp, PERFORMANCE, *PATIENT, "--find-max", "--subjects", "2", "--probe",
                                "0.1", "--searches", "100", "--limit", "1000", "--json", figures, "--hgrm", hgrm,
                                "--plot", svg)
                self.addCleanup(process.kill)
                furrow("watch", daemon.tcp, "--subject", "load-000000", "--wait", "--frames", "150", check=0)
                if how:
                    process.send_signal(how)
                    ended, out, err = finish(process)
            if how is None:
                ended, out, err = finish(process)
            self.assertEqual(ended, code, err)
            written = json.loads(figures.read_text())
            self.assertNotIn("run", written)
            self.assertEqual(written["comparison"]["interrupted"], how is not None)
            self.assertEqual(written["comparison"]["failure"] != "", how is None)
            self.assertGreater(len(written["comparison"]["steps"]), 0)
            self.assertIn("so far" if how else "no answer", out.decode())
            self.assertIn("Loss by rate", "".join(xml.etree.ElementTree.parse(svg).getroot().itertext()))
            self.assertIn("Total count", hgrm.read_text())

    def test_a_daemon_that_goes_away_is_a_failure(self):
        for path in ("--udp", "--tcp"):
            figures = self.folder / "figures.json"
            with Daemon("--no-render") as daemon:
                host, other = (daemon.udp, "tcp") if path == "--udp" else (daemon.tcp, "udp")
                process = spawn("load", host, PERFORMANCE, path, "--other-port", str(daemon.ports[other]), "--duration",
                                "30" if path == "--tcp" else "3", "--drain", "0.2", "--json", figures)
                self.addCleanup(process.kill)
                furrow("watch", daemon.tcp, "--subject", "load-000000", "--wait", "--frames", "2", check=0)
            code, out, err = finish(process)
            self.assertEqual(code, 4, (path, err))
            self.assertIn("The run ended early", out.decode(), path)
            run = json.loads(figures.read_text())["run"]
            self.assertTrue(run["ended_early"])
            self.assertFalse(run["interrupted"])
            self.assertGreater(run["received"], 0, path)

    def test_commands_of_the_manual(self):
        (self.folder / "performance.bvh").symlink_to(PERFORMANCE)
        quick = ["--duration", "0.3", "--late", "60000"]
        seen = set()
        with Daemon("--no-render") as daemon:
            ports = {"localhost": daemon.udp, "localhost:7401": daemon.udp, "7400": daemon.ports["tcp"], "7501": 0}
            for words in commands("docs/LOAD.md"):
                words = [ports.get(w, self.folder / w if w.startswith("out.") else w) for w in words[1:]]
                seen.add(words[0])
                if words[0] == "chaos":
                    process = spawn(*words)
                    self.assertIn("ready", process.stdout.readline().decode())
                    process.send_signal(signal.SIGTERM)
                    self.assertEqual(finish(process)[0], 0)
                    continue
                words[2] = PERFORMANCE
                if "--duration" in words:
                    at = words.index("--duration")
                    del words[at:at + 2]
                if "--find-max" in words:
                    words += ["--rounds", "1", "--searches", "1", "--probe", "0.1", "--limit", "4000"]
                furrow(*words, *quick, "--other-port", daemon.ports["tcp"], check=0)
        self.assertEqual(seen, {"load", "chaos"})

    def test_chaos_listens_on_a_free_or_a_given_tcp_port(self):
        with Daemon("--no-render") as daemon, socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            with Chaos(daemon, "--listen", port) as chaos:
                self.assertEqual(chaos.ports["udp"], port)
                self.assertNotEqual(chaos.ports["tcp"], port)
                free = chaos.ports["tcp"]
            with Chaos(daemon, "--listen-tcp", free) as chaos:
                self.assertEqual(chaos.ports["tcp"], free)
            result = furrow("chaos", "--listen", "0", "--to", daemon.udp, "--to-tcp", daemon.ports["tcp"],
                            "--listen-tcp", port, check=1)
            self.assertIn(f"127.0.0.1:{port} (TCP): cannot listen", result.stderr.decode())

    def test_a_wrong_tcp_port_is_named_in_the_error(self):
        with Daemon("--no-render") as daemon:
            for options in (["--stalled", "2"], ["--both", "--subjects", "2"]):
                # TCP is closed at the number of the UDP port.
                result = furrow("load", daemon.udp, PERFORMANCE, *options, "--other-port", daemon.ports["udp"], check=4)
                said = result.stderr.decode()
                self.assertIn(f"furrow: no connection to 127.0.0.1:{daemon.ports['udp']} over TCP", said)
                self.assertIn("--other-port", said)

    def test_errors_have_messages_and_exit_codes(self):
        with Daemon("--no-render") as daemon:
            port = daemon.ports["udp"]
        # The daemon has ended, so the port is closed.
        for command, code, words in (
                (("load", f"127.0.0.1:{port}", PERFORMANCE), 4, f"127.0.0.1:{port}: no answer (is furrowd"),
                (("load", "no-such-host.invalid", PERFORMANCE), 4, UNKNOWN_HOST),
                (("load", "localhost", "/nonexistent.bvh"), 3, "/nonexistent.bvh"),
                (("load", "[::1", PERFORMANCE), 2, "HOST"),
                (("load", "localhost", PERFORMANCE, "--loss", "2"), 2, "--loss"),
                (("load", "localhost", PERFORMANCE, "--find-max", "--loss", "0.1"), 2, "without injected faults"),
                (("load", "localhost", PERFORMANCE, "--baseline", "--jitter", "3"), 2, "without injected faults"),
                (("load", "localhost", PERFORMANCE, "--black-hole", "1"), 2, "START:LENGTH"),
                (("load", "localhost", PERFORMANCE, "--tcp", "--falsify", "0.2"), 2, "leave out --tcp"),
                (("load", "localhost", PERFORMANCE, "--pid", "2147483647"), 2, "no such process"),
                (("chaos", "--listen", "0", "--to", "localhost", "--black-hole", "x"), 2, "START:LENGTH"),
                (("chaos", "--listen", "0", "--bind", "somewhere", "--to", "localhost"), 2, "numeric"),
                (("chaos", "--listen", "0", "--to", "no-such-host.invalid"), 4, UNKNOWN_HOST)):
            result = furrow(*command)
            self.assertEqual(result.returncode, code, (command, result.stderr.decode()))
            self.assertIn(words, result.stderr.decode(), command)


class PlanTest(unittest.TestCase):
    def test_text_and_json_agree_and_costs_come_from_a_file(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            figures = folder / "plan.json"
            asked = ["plan", "--performers", "10000", "--subscribers", "3", "--json", figures]
            result = furrow(*asked, check=0)
            plan = json.loads(figures.read_text())
            self.assertIn(f"{plan['machines']:.0f} machines serve them", result.stdout.decode())
            # On a machine that needs ten times as long for a pose.
            run = {"cpu_us_per_pose": 300.0, "poses_per_second": 60.0, "resident_bytes": 1e7}
            points = [{"x": x, "run": run} for x in (1, 2)]
            costs = {curve: {"points": points} for curve in ("subjects", "subscribers", "joints", "regions")}
            (folder / "load.json").write_text(json.dumps(costs))
            furrow(*asked, "--costs", folder / "load.json", check=0)
            self.assertEqual(json.loads(figures.read_text())["us_per_pose"], 300.0)
            (folder / "load.json").write_text("{}")
            refused = furrow(*asked, "--costs", folder / "load.json")
            self.assertEqual(refused.returncode, 3)
            self.assertIn("subjects: is missing", refused.stderr.decode())


if __name__ == "__main__":
    unittest.main()
