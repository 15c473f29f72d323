#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the JSON examples of docs/HTTP-API.md with what a running daemon answers.

A block of JSON below <!-- example: METHOD PATH [BODY] --> documents the answer to that request;
<!-- example exactly: ... --> must be equal, else names and types of all fields must be. null matches
anything, an empty list any list, and of a list the first element counts. An example that shows a
"version" must show the daemon's.

Environment: FURROW_BIN.
"""
import json
import re
import sys
import urllib.error
import urllib.request

import documents

PAGE = documents.ROOT / "docs" / "HTTP-API.md"


def differences(documented, real, where="answer"):
    """How the shape of two values differs, as texts."""
    if documented is None or real is None:
        return []
    if isinstance(documented, dict) and isinstance(real, dict):
        if set(documented) == set() or set(real) == set():
            return []
        found = [f"{where}: the daemon does not send '{key}'" for key in documented.keys() - real.keys()]
        found += [f"{where}: '{key}' is not documented" for key in real.keys() - documented.keys()]
        for key in sorted(documented.keys() & real.keys()):
            if key == "version" and documented[key] != real[key]:
                found.append(f"{where}.version: documented {documented[key]}, real {real[key]}")
            found += differences(documented[key], real[key], f"{where}.{key}")
        return sorted(found)
    if isinstance(documented, list) and isinstance(real, list):
        return differences(documented[0], real[0], f"{where}[0]") if documented and real else []
    if is_number(documented) and is_number(real):
        return []
    if type(documented) is not type(real):
        return [f"{where}: documented as {type(documented).__name__}, real {type(real).__name__}"]
    return []


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def ask(address, method, path, body):
    """The JSON of an answer, whatever its status."""
    request = urllib.request.Request(f"http://{address}{path}", method=method, data=body.encode() if body else None,
                                     headers={"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=documents.TIMEOUT) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        return json.load(error)


def examples(text):
    """(line, exactly, method, path, body, documented JSON) of every marked block."""
    for block in documents.blocks(text):
        marker = re.fullmatch(r"example( exactly)?: (\w+) (\S+)(?: (.*))?", block.marker)
        if marker:
            yield block.line, bool(marker[1]), marker[2], marker[3], marker[4], json.loads(block.text)


def main():
    share = documents.programs().resolve().parent / "share" / "furrow"
    recording = share / "recordings" / "performance.bvh"
    problems, count = [], 0
    with documents.Daemon("--play", recording) as daemon, documents.Performer(daemon, recording, "demo"):
        for line, exactly, method, path, body, documented in examples(PAGE.read_text()):
            count += 1
            real = ask(daemon.address("http"), method, path, body)
            found = differences(documented, real)
            if exactly and documented != real:
                found = [f"the daemon answers {json.dumps(real)}"]
            problems += [f"docs/HTTP-API.md:{line}: {method} {path}: {text}" for text in found]
    if count == 0:
        problems.append("docs/HTTP-API.md: no example is marked")
    return documents.report(problems, f"{count} HTTP examples")


if __name__ == "__main__":
    sys.exit(main())
