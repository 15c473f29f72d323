#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills a daemon under load with SIGKILL, starts it again, and measures when each client has weights again.

    restart.py BIN [--rounds N] [--players N]

Clients: `furrow watch` over UDP and TCP, the C library
(libfurrow.so), which is the C++ library with a C interface, and the JavaScript package over UDP and TCP. Load: N publishers
over UDP. Prints the median and the longest time from the daemon's ready line to the first new line of each client. Ends with
exit code 1 if a client did not come back within 30 s. BIN: the folder with furrow and furrowd.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import time

from programs import Daemon, Lines, recording_of

HERE = pathlib.Path(__file__).parent
PATIENCE = 30.0


def client_commands(folder, daemon):
    """Command lines by name. Each prints a line per frame."""
    furrow, build = folder / "furrow", folder.parent
    udp = f"furrow://{daemon.host()}?subject=player-0&transport=udp"
    tcp = f"furrow://{daemon.host('tcp')}?subject=player-0&transport=tcp"
    watch = ["--wait", "--pattern", "brow_l.*", "--format", "csv"]
    commands = {"watch, UDP": [furrow, "watch", udp, *watch], "watch, TCP": [furrow, "watch", tcp, *watch],
                "C library, UDP": [sys.executable, HERE / "c_client.py", build / "lib" / "libfurrow.so", udp, "player-0"],
                "C library, TCP": [sys.executable, HERE / "c_client.py", build / "lib" / "libfurrow.so", tcp, "player-0"]}
    package = build / "client" / "js" / "furrow" / "dist"
    if package.exists():
        for name, address in (("UDP", udp), ("TCP", tcp)):
            commands[f"JavaScript, {name}"] = ["node", HERE / "js_client.mjs", package, address]
    return commands


def start(command):
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
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
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--players", type=int, default=10)
    options = parser.parse_args()
    folder = options.bin.resolve()
    daemon = Daemon(folder, "--no-render")
    players, clients, missing = [], {}, set()
    try:
        for i in range(options.players):
            players.append(start([folder / "furrow", "play", recording_of(folder), "--to", daemon.host(), "--subject",
                                  f"player-{i}", "--loop"])[0])
        clients = {name: start(command) for name, command in client_commands(folder, daemon).items()}
        wait_for_all(clients, 0.0)
        times = {name: [] for name in clients}
        for round_number in range(options.rounds):
            daemon.kill()
            # The second half of the rounds: clients have given up trying often.
            time.sleep(0.5 if round_number % 2 == 0 else 5.0)
            daemon = Daemon(folder, "--no-render", ports={name: daemon.ports[name] for name in ("tcp", "udp")})
            found = wait_for_all(clients, daemon.ready_at)
            for name in clients:
                if name in found:
                    times[name].append(found[name] - daemon.ready_at)
                else:
                    missing.add(name)
            time.sleep(1.0)
    finally:
        for process in [*players, *(process for process, _ in clients.values())]:
            process.kill()
            process.wait()
        daemon.stop()
    print("| client | median (s) | longest (s) |\n|---|---|---|")
    for name, values in times.items():
        late = "never" if name in missing else f"{max(values):.2f}"
        print(f"| {name} | {statistics.median(values) if values else float('nan'):.2f} | {late} |")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
