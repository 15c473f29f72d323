#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Grafana dashboard and the alert rules against a real Prometheus that scrapes a real daemon: every query has a
result, and alerts fire. Exit code 77 means skipped (prometheus or promtool is missing).

FURROW_DASHBOARD=FILE saves what the panels show at the end, for docs/dashboard/draw.mjs.
"""
import json
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.parse
import urllib.request

from furrow_testing import BIN, GUARD, SOURCE, Daemon, free_port, spawn

PROMETHEUS = shutil.which("prometheus")
PROMTOOL = shutil.which("promtool")
DASHBOARD = SOURCE / "deploy" / "grafana" / "furrow.json"
RULES = SOURCE / "deploy" / "prometheus" / "furrow.rules.yml"


def panels():
    """(panel, number of the target, query for all instances) of every query."""
    for panel in json.loads(DASHBOARD.read_text())["panels"]:
        for number, target in enumerate(panel.get("targets", [])):
            query = target["expr"].replace("$__rate_interval", "10s").replace("$instance", ".*")
            yield panel, number, query


def alerts():
    """(name, quantity, whole expression) of every alert."""
    text = RULES.read_text()
    for name, expr in re.findall(r"- alert: (\w+)\n +expr: (?:>-\n)?(.*?)\n +(?:for|labels):", text, re.S):
        expr = " ".join(expr.split())
        quantity = re.fullmatch(r"(.+) (?:==|>) [\d.]+", expr)
        assert quantity, f"{name}: expected a quantity, a comparison and a number: {expr}"
        yield name, quantity[1], expr


def datagrams_dropped(port):
    """How many datagrams to this port the kernel has dropped, because nobody read them in time."""
    rows = [line.split() for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]]
    return sum(int(row[12]) for row in rows if row[1].endswith(f":{port:04X}"))


class Prometheus:
    """A server in a with-block that scrapes daemons by their host names and evaluates the rules, every second."""

    def __init__(self, *targets):
        self.folder = tempfile.TemporaryDirectory()
        self.address = f"127.0.0.1:{free_port()}"
        config = pathlib.Path(self.folder.name) / "prometheus.yml"
        example = (RULES.parent / "prometheus.yml").read_text()
        example = example.replace("scrape_interval: 10s", "scrape_interval: 1s\n  evaluation_interval: 1s")
        example = example.replace('["127.0.0.1:7480"]', json.dumps(targets))
        config.write_text(example.replace("furrow.rules.yml", str(RULES)))
        self.command = [PROMETHEUS, f"--config.file={config}", f"--storage.tsdb.path={self.folder.name}/data",
                        f"--web.listen-address={self.address}", "--query.lookback-delta=10s"]

    def __enter__(self):
        self.log = open(pathlib.Path(self.folder.name) / "log", "w+")  # pylint: disable=consider-using-with
        self.process = subprocess.Popen(self.command, stdout=self.log, stderr=self.log)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(GUARD)
        self.log.close()
        self.folder.cleanup()

    def ask(self, what, **parameters):
        """The result of an API query; None if Prometheus does not answer yet."""
        address = f"http://{self.address}/api/v1/{what}?" + urllib.parse.urlencode(parameters)
        try:
            with urllib.request.urlopen(address, timeout=GUARD) as answer:
                return json.load(answer)["data"]["result"]
        except urllib.error.HTTPError as error:
            if error.code == 503:  # it starts
                return None
            raise AssertionError(f"{parameters}: {error.read().decode()}") from error
        except OSError:
            return None

    def query(self, expr):
        """The values of an instant query; None if Prometheus does not answer yet."""
        result = self.ask("query", query=expr)
        return result if result is None else [float(series["value"][1]) for series in result]

    def await_alert(self, name):
        """Waits until the alert fires, or waits for its time to fire."""
        self.await_values(f'ALERTS{{alertname="{name}"}}')

    def await_values(self, expr):
        """Waits until the query has results that are numbers."""
        deadline = time.monotonic() + 60
        while True:
            values = self.query(expr)
            if values and all(map(math.isfinite, values)):
                return values
            if time.monotonic() > deadline:
                self.log.seek(0)
                raise AssertionError(f"no values after 60 s: {expr}: {values}\n{self.log.read()[-2000:]}")
            time.sleep(0.2)  # between two looks at another program


def save_panels(prometheus, start, file):
    """Saves what each panel has shown since `start`, in seconds since 1970."""
    found = {}
    for panel, number, query in panels():
        for series in prometheus.ask("query_range", query=query, start=start, end=time.time(), step=1):
            found.setdefault(panel["id"], []).append(
                {"target": number, "labels": series["metric"], "values": series["values"]})
    pathlib.Path(file).write_text(json.dumps(found))


class DashboardTest(unittest.TestCase):
    def small_disk(self):
        """A folder on a disk of its own."""
        folder = self.enterContext(tempfile.TemporaryDirectory())
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", folder], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", folder], check=True)
        return folder

    def test_every_query_has_a_result_and_alerts_fire(self):
        software = {"LIBGL_ALWAYS_SOFTWARE": "1"}
        takes = self.enterContext(tempfile.TemporaryDirectory())
        with Daemon("--http", "0", "--allow-host", "localhost.furrow.example", "--record", takes, env=software) as daemon:
            if "render=on" not in daemon.ready:
                self.skipTest("no OpenGL 4.5 here, so pictures take no time")
            clients = [spawn("play", "performance", "--to", daemon.udp, "--udp", "--loop"),
                       # Nobody reads its weights, and a pipe is small.
                       subprocess.Popen([BIN / "furrow", "watch", daemon.tcp, "--wait", "--format", "csv"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL),
                       spawn("frames", daemon.tcp, "--out", takes + "/frames", "--size", "64x64", "--wait")]
            try:
                with Prometheus(f"localhost:{daemon.ports['http']}") as prometheus:
                    for kind in ("pictures", "weights"):
                        prometheus.await_values(f"furrow_{kind}_sent_total > 3")
                    start = time.time()
                    self.check_queries(prometheus)
                    self.check_stall_and_loss(prometheus, daemon)
                    if "FURROW_DASHBOARD" in os.environ:
                        time.sleep(30)  # what follows is in the picture, too
                        save_panels(prometheus, start, os.environ["FURROW_DASHBOARD"])
            finally:
                for client in clients:
                    client.kill()
                    client.communicate()

    def check_queries(self, prometheus):
        seen = 0
        for panel, _, query in panels():
            self.assertNotIn("$", query)
            with self.subTest(panel=panel["title"], query=query):
                prometheus.await_values(query)
            seen += 1
        self.assertGreater(seen, 40)
        for name, quantity, _ in alerts():
            with self.subTest(alert=name):
                prometheus.await_values(quantity.replace("[5m]", "[10s]"))

    def check_stall_and_loss(self, prometheus, daemon):
        """Performers are gone, the daemon stands still several times, and then for so long that datagrams get lost."""
        performers = [spawn("play", "performance", "--to", daemon.udp, "--udp", "--loop", "--subject", f"lost-{i}")
                      for i in range(4)]
        try:
            prometheus.await_values("furrow_subjects >= 5")
        finally:
            for performer in performers:
                performer.kill()
                performer.communicate()
        prometheus.await_alert("FurrowSubjectsLost")
        for _ in range(4):
            daemon.process.send_signal(signal.SIGSTOP)
            time.sleep(0.3)  # what the alert is about
            daemon.process.send_signal(signal.SIGCONT)
            stalls = prometheus.query("furrow_stalls_total")[0]
            prometheus.await_values(f"furrow_stalls_total > {stalls}")
        prometheus.await_alert("FurrowStalls")
        daemon.process.send_signal(signal.SIGSTOP)
        try:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as flood:
                while datagrams_dropped(daemon.ports["udp"]) < 5000:
                    flood.sendto(b"flood", ("127.0.0.1", daemon.ports["udp"]))
            # A scrape fails after 1 s.
            prometheus.await_alert("FurrowDown")
        finally:
            daemon.process.send_signal(signal.SIGCONT)
        prometheus.await_alert("FurrowLosesDatagrams")

    @unittest.skipIf(os.geteuid(), "a full disk needs root")
    def test_a_daemon_without_gpu_and_disk_fires_alerts(self):
        disk = self.small_disk()
        with Daemon("--http", "0", "--record", disk, "--render-device", "none-of-this-name") as daemon:
            with open(pathlib.Path(disk, "other files"), "wb", buffering=0) as other, self.assertRaises(OSError):
                while other.write(bytes(65536)) == 65536:
                    pass
                other.write(b"full")
            player = spawn("play", "performance", "--to", daemon.udp, "--udp", "--loop")
            try:
                with Prometheus(f"127.0.0.1:{daemon.ports['http']}") as prometheus:
                    for alert in ("FurrowNoRenderer", "FurrowRecordingPaused", "FurrowRecordingDrops"):
                        prometheus.await_alert(alert)
            finally:
                player.kill()
                player.communicate()


class RulesTest(unittest.TestCase):
    def test_every_alert_is_valid_and_fires(self):
        for command in (["check", "rules", RULES.name], ["test", "rules", "furrow.rules.test.yml"],
                        ["check", "config", "prometheus.yml"]):
            done = subprocess.run([PROMTOOL, *command], cwd=RULES.parent, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        tested = (RULES.parent / "furrow.rules.test.yml").read_text()
        for name, _, _ in alerts():
            self.assertIn(f'alertname="{name}"', tested)

    def test_the_dashboard_is_complete(self):
        dashboard = json.loads(DASHBOARD.read_text())
        variables = {variable["name"]: variable for variable in dashboard["templating"]["list"]}
        self.assertEqual(variables["datasource"]["type"], "datasource")
        numbers = [panel["id"] for panel in dashboard["panels"]]
        self.assertEqual(len(numbers), len(set(numbers)))
        for panel in dashboard["panels"]:
            if panel["type"] != "row":
                self.assertEqual(panel["datasource"]["uid"], "${datasource}", panel["title"])
                self.assertTrue(panel["targets"], panel["title"])
                for target in panel["targets"]:  # of several daemons
                    if "by (" in target["expr"]:
                        self.assertIn("{{instance}}", target["legendFormat"], panel["title"])


if __name__ == "__main__":
    if not PROMETHEUS or not PROMTOOL:
        print("skipped: prometheus is not installed")
        sys.exit(77)
    unittest.main()
