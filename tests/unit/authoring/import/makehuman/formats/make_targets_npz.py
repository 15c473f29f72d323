#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes tests/fuzz/seeds/npz/ with NumPy, as MakeHuman's compile_targets.py packs its targets.

    tests/unit/authoring/import/makehuman/formats/make_targets_npz.py

targets.npz holds the targets nose/nose-hump-incr (vertices 0 and 3) and head/head-oval (none), and a licence.
vector.npy is one array alone.
"""
import io
import pathlib
import zipfile

import numpy

FOLDER = next(p for p in pathlib.Path(__file__).resolve().parents if (p / "CONTRIBUTING.md").exists())
FOLDER = FOLDER / "tests" / "fuzz" / "seeds" / "npz"
DTYPE = [("index", "u4"), ("vector", "(3,)f4")]
TARGETS = {"nose/nose-hump-incr": [(0, (1.0, -0.25, 0.0)), (3, (0.0, 0.0005, -32.0))], "head/head-oval": []}


def npy(array):
    file = io.BytesIO()
    numpy.save(file, numpy.ascontiguousarray(array))
    return file.getvalue()


def main():
    FOLDER.mkdir(exist_ok=True)
    with zipfile.ZipFile(FOLDER / "targets.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        def write(name, data):
            archive.writestr(zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0)), data, zipfile.ZIP_DEFLATED)
        write("targets/targets.license.npy", npy(numpy.array(["CC0"])))
        for name, rows in TARGETS.items():
            raw = numpy.asarray(rows, DTYPE)
            vector = numpy.round(raw["vector"] * 1e3).astype(numpy.int16)
            write(f"targets/{name}.index.npy", npy(raw["index"].astype(numpy.uint16)))
            write(f"targets/{name}.vector.npy", npy(vector))
    (FOLDER / "vector.npy").write_bytes(npy(numpy.arange(6, dtype=numpy.int16).reshape(2, 3)))


if __name__ == "__main__":
    main()
