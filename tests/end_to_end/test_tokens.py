#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tokens and their keys on the command line."""
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

import furrow_testing

sys.path.insert(0, os.path.join(os.environ["FURROW_SOURCE"], "tests", "conformance"))

DONE, USAGE, BAD_INPUT = 0, 2, 3


def furrow(*arguments, check):
    """Runs `furrow`; its output is text."""
    done = furrow_testing.furrow(*arguments, check=check)
    return subprocess.CompletedProcess(done.args, done.returncode, done.stdout.decode(), done.stderr.decode())


class TokensTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.keys = self.root / "keys"

    def key_ids(self):
        lines = furrow("token", "key", "list", "--key", self.keys, check=DONE).stdout.splitlines()
        return [line.split()[0] for line in lines[1:]]

    def show(self, token, *options):
        """What `show` prints, as words by their names."""
        text = furrow("token", "show", token, *options, check=DONE).stdout
        return dict(line.split(maxsplit=1) for line in text.splitlines())

    def test_from_a_key_to_a_shown_token(self):
        said = furrow("token", "key", "new", "--key", self.keys, check=DONE).stdout
        self.assertRegex(said, r": new key [0-9a-f]{8} until 2\d\d\d-.*; 1 key in the file\n")
        self.assertEqual(stat.S_IMODE(self.keys.stat().st_mode), 0o600)
        token = self.root / "stage.token"
        furrow("token", "new", "--role", "publish,watch", "--role", "direct", "--subjects", "stage-*", "--for", "8h",
               "--audience", "stage-a", "--rate", "4000", "--client", "0x2a", "--key", self.keys, "--out", token,
               check=DONE)
        self.assertEqual(stat.S_IMODE(token.stat().st_mode), 0o600)
        public = self.show(token)
        self.assertEqual(public.keys(), {"key", "expires"})
        self.assertRegex(public["expires"], r"Z \(in 7 h 59 min\)$|Z \(in 8 h 0 min\)$")
        shown = self.show(token, "--key", self.keys)
        self.assertEqual(shown["key"], self.key_ids()[0])
        self.assertEqual((shown["roles"], shown["subjects"]), ("publish,watch,direct", "stage-*"))
        self.assertEqual((shown["server"], shown["rate"]), ("stage-a", "4000 packets per second"))
        self.assertEqual(shown["client"], "0x000000000000002a")
        # The text itself is as good as the file, and no output repeats a secret.
        text = token.read_text().strip()
        again = self.show(text, "--key", self.keys)
        for words in (shown, again):
            words["expires"] = words["expires"].split()[0]  # without "(in 8 h 0 min)", which depends on the clock
        self.assertEqual(again, shown)
        secret = self.keys.read_text().split()[-1]
        self.assertNotIn(secret, "".join(shown.values()) + said)

    def test_the_second_implementation_reads_it(self):
        try:
            import secure
        except ImportError:
            self.skipTest("python3-cryptography is not installed")
        import base64
        furrow("token", "key", "new", "--key", self.keys, check=DONE)
        text = furrow("token", "new", "--role", "operate", "--key", self.keys, check=DONE).stdout.strip()
        token, client_key = secure.parse_token_text(text)
        key = base64.urlsafe_b64decode(self.keys.read_text().split()[-1] + "=")
        opened = secure.open_token(token, key)
        self.assertEqual((opened["roles"], opened["subjects"], opened["audience"]), ("operate", "*", ""))
        self.assertEqual(opened["client_key"], client_key.hex())

    def test_keys_rotate_without_a_gap(self):
        furrow("token", "key", "new", "--key", self.keys, check=DONE)
        old = furrow("token", "new", "--role", "watch", "--key", self.keys, check=DONE).stdout.strip()
        furrow("token", "key", "new", "--key", self.keys, "--for", "30d", check=DONE)
        new = furrow("token", "new", "--role", "watch", "--key", self.keys, check=DONE).stdout.strip()
        first, second = self.key_ids()
        self.assertEqual(self.show(old, "--key", self.keys)["key"], first)
        self.assertEqual(self.show(new, "--key", self.keys)["key"], second)
        furrow("token", "key", "retire", first, "--key", self.keys, check=DONE)
        self.assertEqual(self.key_ids(), [second])
        error = furrow("token", "show", old, "--key", self.keys, check=BAD_INPUT).stderr
        self.assertIn(f"the file does not have the key {first} of the token", error)

    def test_mistakes_get_one_clear_message(self):
        furrow("token", "key", "new", "--key", self.keys, "--for", "1h", check=DONE)
        new = ["token", "new", "--role", "watch", "--key", self.keys]
        for arguments, code, message in [
            ([*new, "--for", "2h"], BAD_INPUT, "expires before the token would"),
            ([*new, "--for", "soon"], USAGE, "'soon' is not a duration such as 90s, 30m, 8h, 14d"),
            ([*new, "--role", "admin"], USAGE, "admin"),
            ([*new, "--client", "me"], USAGE, "'me' is not a number of 64 bits"),
            ([*new, "--for", "1m", "--subjects", ""], BAD_INPUT, "the pattern of subjects is empty"),
            ([*new, "--for", "1m", "--audience", "a" * 48], BAD_INPUT, "the name of the server has 48 bytes"),
            (["token", "new", "--role", "watch", "--key", self.root / "absent"], BAD_INPUT, "no such file"),
            (["token", "show", "frw1_abc"], BAD_INPUT, "the token has 8 characters instead of 389"),
            (["token", "show", self.root / "absent"], BAD_INPUT, "no such file"),
            (["token", "key", "retire", "12345678", "--key", self.keys], BAD_INPUT, "the file has no key '12345678'"),
            (["token", "key", "list", "--key", "/dev/null"], BAD_INPUT, "not a regular file"),
        ]:
            with self.subTest(arguments=arguments):
                done = furrow(*arguments, check=code)
                self.assertIn(message, done.stderr)

    def test_files_that_others_can_read_are_refused(self):
        furrow("token", "key", "new", "--key", self.keys, check=DONE)
        self.keys.chmod(0o640)
        for command in (["new", "--role", "watch"], ["key", "list"], ["key", "new"]):
            error = furrow("token", *command, "--key", self.keys, check=BAD_INPUT).stderr
            self.assertIn(f"run: chmod 600 {self.keys}", error)

    def test_a_foreign_file_is_not_replaced_by_keys(self):
        self.keys.write_text("something else\n")
        self.keys.chmod(0o600)
        furrow("token", "key", "new", "--key", self.keys, check=BAD_INPUT)
        self.assertEqual(self.keys.read_text(), "something else\n")


if __name__ == "__main__":
    unittest.main()
