#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills a daemon under load with SIGKILL, starts it again, and measures when each client has weights again.

    restart.py BIN [--secure] [--rounds N] [--players N]

Clients: `furrow watch` and the C library (libfurrow.so, which is the C++ library with a C interface) over UDP and TCP, the
JavaScript package over UDP and TCP, the page in Chromium (a WebSocket), and the Godot 3 add-on. Load: N publishers over UDP.
--secure: the daemon requires tokens; UDP is sealed, and TCP and the web port speak TLS. Godot 3 knows no TLS 1.3 and is left out.
Prints the median and the longest time from the daemon's ready line to the first new line of each client. Ends with exit code 1 if
a client did not come back within 30 s. BIN: the folder with furrow and furrowd. What is not installed or built is left out.
"""
import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from programs import Daemon, Lines, make_certificate, recording_of

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PATIENCE = 30.0


class Setup:
    """How the daemon runs, and how clients reach it."""

    def __init__(self, folder, scratch, secure):
        self.folder, self.scratch, self.secure = folder, scratch, secure
        self.flags, self.tokens = ["--no-render"], {}
        if secure:
            keys = scratch / "keys"
            self.furrow("token", "key", "new", "--key", keys)
            for role in ("publish", "watch"):
                self.tokens[role] = scratch / f"{role}.token"
                self.furrow("token", "new", "--role", role, "--subjects", "*", "--for", "1h", "--key", keys, "--out", self.tokens[role])
            made = make_certificate(scratch)
            if made is None:
                sys.exit("restart.py: --secure needs openssl")
            self.certificate, key = made
            self.flags += ["--security", "required", "--keys", keys, "--tls-certificate", self.certificate, "--tls-key", key]
        self.daemon = Daemon(folder, *self.flags, ports={"tcp": 0, "udp": 0, "http": 0})

    def furrow(self, *words):
        subprocess.run([self.folder / "furrow", *map(str, words)], check=True, capture_output=True)

    def restart(self):
        self.daemon = Daemon(self.folder, *self.flags, ports=self.daemon.ports)

    def address(self, port, **more):
        """The address of player-0 for a client of this kind of port."""
        if self.secure:
            more["token"] = self.tokens["watch"]
        if self.secure and port != "udp":
            more |= {"tls": 1, "tls-authority": self.certificate}
        words = {"subject": "player-0", **more}
        return f"furrow://{self.daemon.host(port)}?" + "&".join(f"{name}={value}" for name, value in words.items())

    def players(self, count):
        token = ["--token", self.tokens["publish"]] if self.secure else []
        return [start([self.folder / "furrow", "play", recording_of(self.folder), "--to", self.daemon.host(), "--udp", "--subject",
                       f"player-{i}", "--loop", *token])[0] for i in range(count)]

    def clients(self):
        """Command lines by name. Each prints a line per frame."""
        build = self.folder.parent
        watch = ["--wait", "--pattern", "brow_l.*", "--format", "csv"]
        commands = {}
        for port in ("udp", "tcp"):
            address, name = self.address(port, transport=port), port.upper()
            commands[f"watch, {name}"] = [self.folder / "furrow", "watch", address, *watch]
            commands[f"C library, {name}"] = [sys.executable, HERE / "c_client.py", build / "lib" / "libfurrow.so", address, "player-0"]
        package = build / "client" / "js" / "furrow" / "dist"
        if package.exists():
            for port in ("udp", "tcp"):
                commands[f"JavaScript, {port.upper()}"] = ["node", HERE / "js_client.mjs", package, self.address(port, transport=port)]
        if pathlib.Path("/usr/bin/chromium").exists() and (ROOT / "tests" / "browser" / "node_modules").exists():
            scheme = "https" if self.secure else "http"
            page = f"{scheme}://{self.daemon.host('http')}/?subject=player-0"
            commands["page"] = ["node", HERE / "page_client.mjs", page, *([self.tokens["watch"]] if self.secure else [])]
        if shutil.which("godot3-server") and not self.secure:
            commands["Godot 3"] = ["godot3-server", "--path", self.godot_project(), "-s", "godot_client.gd", self.daemon.host("http"),
                                   "player-0"]
        return commands

    def godot_project(self):
        project = self.scratch / "godot"
        shutil.copytree(ROOT / "client" / "engines" / "godot" / "addons", project / "addons")
        shutil.copy(ROOT / "tests" / "engines" / "godot" / "project.godot", project)
        shutil.copy(HERE / "godot_client.gd", project)
        return project


def start(command):
    environment = {**os.environ, "FURROW_ARTEFACTS": tempfile.gettempdir()}
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment)
    return process, Lines(process.stdout)


def wait_for_all(clients, moment):
    """The time of each client's first line after `moment`."""
    deadline = time.monotonic() + PATIENCE
    found = {}
    while len(found) < len(clients) and time.monotonic() < deadline:
        for name, (_, lines) in clients.items():
            at = lines.first_after(moment)
            if name not in found and at is not None:
                found[name] = at
        time.sleep(0.005)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--secure", action="store_true")
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--players", type=int, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        sys.exit(measure(Setup(options.bin.resolve(), pathlib.Path(scratch), options.secure), options))


def measure(setup, options):
    players, clients, missing = [], {}, set()
    try:
        players = setup.players(options.players)
        clients = {name: start(command) for name, command in setup.clients().items()}
        missing = set(clients) - set(wait_for_all(clients, 0.0))
        times = {name: [] for name in clients}
        for round_number in range(options.rounds):
            setup.daemon.kill()
            # In every other round, clients have given up trying often.
            time.sleep(0.5 if round_number % 2 == 0 else 5.0)
            setup.restart()
            ready_at = setup.daemon.ready_at
            found = wait_for_all(clients, ready_at)
            missing |= set(clients) - set(found)
            for name, at in found.items():
                times[name].append(at - ready_at)
            time.sleep(1.0)
    finally:
        for process in [*players, *(process for process, _ in clients.values())]:
            process.terminate()
        for process in [*players, *(process for process, _ in clients.values())]:
            try:
                process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        setup.daemon.stop()
    print("| client | median (s) | longest (s) |\n|---|---|---|")
    for name, values in times.items():
        late = "never" if name in missing else f"{max(values):.2f}"
        print(f"| {name} | {statistics.median(values) if values else float('nan'):.2f} | {late} |")
    return 1 if missing else 0


if __name__ == "__main__":
    main()
