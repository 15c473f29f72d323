#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seconds from the start of furrowd to its first picture, with an empty cache of shaders and with a full one.

    bench/render/first_picture.py build/bench/bin [--runs 5] [--size 640x400] [--shading skin]

The daemon plays a recording, as `furrowd --play performance` does, and one viewer asks for its pictures as soon as the
ready line appears. Each run has a cache folder of its own, which the second start of the run finds full."""
import argparse
import os
import pathlib
import re
import resource
import signal
import statistics
import subprocess
import tempfile
import time
import urllib.request


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def first_picture(programs, query, cache):
    """Starts a daemon, and returns its seconds to the ready line, to the first picture, and of processor time."""
    before = processor_seconds()
    began = time.monotonic()
    daemon = subprocess.Popen(
        [programs / "furrowd", "--play", "performance", "--tcp", "0", "--udp", "0", "--http", "0"],
        env={**os.environ, "CACHE_DIRECTORY": str(cache)}, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        line = daemon.stdout.readline()
        ready = time.monotonic() - began
        host = re.search(r"http=(\S+)", line).group(1)
        with urllib.request.urlopen(f"http://{host}/mjpeg?{query}", timeout=120) as pictures:
            while not pictures.read(1):
                pass
            # The header of a part comes with its picture; read on to the bytes of the JPEG.
            while pictures.read(1) != b"\xff":
                pass
        shown = time.monotonic() - began
    finally:
        daemon.send_signal(signal.SIGTERM)
        daemon.wait(timeout=60)
    return ready, shown, processor_seconds() - before


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of furrowd")
    parser.add_argument("--runs", type=int, default=5, help="number of runs (default: 5)")
    parser.add_argument("--size", default="640x400", help="size of the picture in pixels (default: 640x400)")
    parser.add_argument("--shading", default="skin", help="skin or diffuse (default: skin)")
    options = parser.parse_args()
    width, height = options.size.split("x")
    query = f"width={width}&height={height}&shading={options.shading}"
    rows = {"empty": [], "full": []}
    for _ in range(options.runs):
        with tempfile.TemporaryDirectory() as cache:
            for state, times in rows.items():
                times.append(first_picture(options.programs.resolve(), query, cache))
    print("cache  ready [s]  first picture [s]  processor time until the end [s]")
    for state, times in rows.items():
        medians = [statistics.median(column) for column in zip(*times)]
        print(f"{state:5}  {medians[0]:9.2f}  {medians[1]:17.2f}  {medians[2]:32.2f}")


if __name__ == "__main__":
    main()
