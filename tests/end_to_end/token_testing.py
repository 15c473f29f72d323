# SPDX-License-Identifier: Apache-2.0
"""Tests whose daemons require tokens."""
import pathlib
import tempfile
import unittest

from furrow_testing import GUARD, furrow, spawn


class TokenTest(unittest.TestCase):
    """Has a folder (`root`) with a file of keys, options of a daemon that requires tokens (`strict`), and makes tokens."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.keys = self.root / "keys"
        furrow("token", "key", "new", "--key", self.keys, check=0)
        self.strict = ("--security", "required", "--keys", self.keys)

    def token(self, role, subjects="*", time="1h", keys=None):
        path = self.root / f"{role}-{len(list(self.root.iterdir()))}.token"
        furrow("token", "new", "--role", role, "--subjects", subjects, "--for", time, "--key", keys or self.keys,
               "--out", path, check=0)
        return path

    def start(self, *args):
        """Starts `furrow`, and ends it with the test."""
        process = spawn(*args)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait, GUARD)
        self.addCleanup(process.kill)
        return process
