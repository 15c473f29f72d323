#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The .meta files of the Unity package. Unity cannot write them into a package that it reads from a cache, and ignores
files without one. The GUID of a file follows from its path, so it stays the same for ever.

usage: meta_files.py PACKAGE      writes all .meta files
"""
import hashlib
import pathlib
import sys

SEED = "com.furrow.unity/"
TAIL = """  externalObjects: {}
  userData:
  assetBundleName:
  assetBundleVariant:
"""
IMPORTERS = {".cs": "MonoImporter", ".asmdef": "AssemblyDefinitionImporter", ".hlsl": "ShaderIncludeImporter",
             "package.json": "PackageManifestImporter"}


def text_of(path, package):
    """The content of the .meta file of `path`."""
    name = path.relative_to(package).as_posix()
    importer = IMPORTERS.get(path.name) or IMPORTERS.get(path.suffix, "DefaultImporter")
    folder = "folderAsset: yes\n" if path.is_dir() else ""
    return (f"fileFormatVersion: 2\nguid: {hashlib.md5((SEED + name).encode()).hexdigest()}\n{folder}{importer}:\n{TAIL}")


def assets(package):
    """All files and folders that Unity imports. It skips names that end in ~."""
    for path in sorted(package.rglob("*")):
        parts = path.relative_to(package).parts
        if path.suffix != ".meta" and not any(part.endswith("~") or part.startswith(".") for part in parts):
            yield path


def meta_of(path):
    return path.with_name(path.name + ".meta")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    for asset in assets(root):
        meta_of(asset).write_text(text_of(asset, root))
