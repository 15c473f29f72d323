#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Adds poses of a swinging leg to the default rig and, with `sliding`, gives its hips sliding masks.

usage: sliding_rig.py fixed|sliding RIG OUT (docs/make-pictures.sh calls it)
"""
import json
import re
import sys

POSES = {"leg_forwards": [-65, 0, 0], "leg_between": [-46, 0, 46], "leg_aside": [0, 0, 60]}


def hip(side):
    """The region of one hip with a sliding mask. It replaces the front and the back region."""
    return {
        "name": f"hip_{side}",
        "combine": "sum",
        "mask": {"kind": "sliding", "driver": f"hip_{side}"},
        "feeds": [{
            "map": "folds",
            "sources": [{"from": f"hip_{side}.{way}", "gain": 3}
                        for way in ("front", "back", "left", "right")],
        }],
    }


def main(kind, source, out):
    with open(source, encoding="utf-8") as file:
        rig = json.loads(re.sub(r"(?m)^\s*//.*$", "", file.read()))
    for name, degrees in POSES.items():
        rig["reference_poses"].append(
            {"name": name, "joints": [{"joint": "upper_leg_l", "euler_degrees": degrees}]})
    if kind == "sliding":
        rig["regions"] = [r for r in rig["regions"] if not r["name"].startswith("hip_")]
        rig["regions"] += [hip("l"), hip("r")]
    with open(out, "w", encoding="utf-8") as file:
        json.dump(rig, file, indent=1)


if __name__ == "__main__":
    main(*sys.argv[1:])
