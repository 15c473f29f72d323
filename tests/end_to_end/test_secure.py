#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A daemon that requires tokens, and every command that connects to it."""
import os
import shutil
import signal
import unittest
import urllib.error
import urllib.request

from furrow_testing import GUARD, SHARE, Daemon, furrow
from test_reconnect import LOST, Killed, Output, rows_after
from token_testing import TokenTest

PERFORMANCE = SHARE / "recordings" / "performance.bvh"
SHORT = ("--pattern", "brow_l.*", "--format", "csv")
FAILED, BAD_INPUT, NO_CONNECTION = 1, 3, 4
REFUSED = "the daemon refuses the token: the server does not have the key of the token; trying again"


class SecureTest(TokenTest):
    def end(self, process):
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=GUARD), 0)

    def test_every_command_works_with_a_token(self):
        publish, watch = self.token("publish", "ada"), self.token("watch", "ada")
        with Daemon("--no-render", *self.strict) as daemon:
            player = self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop", "--token", publish)
            for address, options in (
                    (daemon.udp, ("--token", watch)),  # a token means UDP
                    (daemon.tcp, ("--token", watch, "--tcp")),
                    (f"furrow://{daemon.udp}?token={watch}", ()),
                    (f"furrow://{daemon.udp}?token={watch.read_text().strip()}", ())):
                seen = furrow("watch", address, "--subject", "ada", "--wait", "--frames", 5, *SHORT, *options, check=0)
                self.assertEqual(len(seen.stdout.decode().splitlines()), 6)
            take = self.root / "take.mcap"
            furrow("record", daemon.tcp, "--out", take, "--duration", 0.3, "--token", watch, check=0)
            self.assertRegex(furrow("info", take, check=0).stdout.decode(), r"\bada\b")
            self.end(player)
            player = self.start("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "ada", "--loop", "--token",
                                publish)
            furrow("watch", daemon.udp, "--subject", "ada", "--wait", "--frames", 5, *SHORT, "--token", watch, check=0)
            self.end(player)
            both = self.token("publish,watch", "load-*")
            furrow("load", daemon.udp, PERFORMANCE, "--subjects", 2, "--duration", 0.5, "--late", 60000, "--other-port",
                   daemon.ports["tcp"], "--token", both, check=0)

    def test_weights_are_those_of_a_daemon_without_tokens(self):
        tables = []
        for strict, options in ((), ((), ())), (self.strict, (("--token", self.token("publish")),
                                                              ("--token", self.token("watch")))):
            with Daemon("--no-render", *strict) as daemon:
                watcher = self.start("watch", daemon.udp, "--udp", "--subject", "ada", "--wait", "--format", "csv", "--frames",
                                     150, *options[1])
                self.assertIn("waiting", watcher.stderr.readline().decode())
                player = self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", *options[0])
                rows = {}
                for line in watcher.communicate(timeout=GUARD)[0].decode().splitlines()[1:]:
                    frame, _, weights = line.split(",", 2)
                    rows[int(frame)] = weights
                self.end(player)
                tables.append(rows)
        common = tables[0].keys() & tables[1].keys()
        self.assertGreater(len(common), 100)
        self.assertEqual(*({frame: table[frame] for frame in common} for table in tables))

    def test_without_a_valid_token_there_is_one_clear_message(self):
        expired = self.token("publish,watch", time="1s")
        while "expired" not in furrow("token", "show", expired, check=0).stdout.decode():
            pass
        foreign = self.root / "foreign.keys"
        furrow("token", "key", "new", "--key", foreign, check=0)
        damaged = self.root / "damaged.token"
        shutil.copy(self.token("watch"), damaged)
        text = damaged.read_text()
        damaged.write_text(text.replace(text[50:54], "AAAA" if text[50:54] != "AAAA" else "BBBB"))
        os.chmod(damaged, 0o600)
        cases = (
            ((), FAILED, "the daemon requires a token"),
            (("--token", self.token("publish,watch", keys=foreign)), FAILED, "does not have the key"),
            (("--token", damaged), BAD_INPUT, "checksum"),
            (("--token", self.root / "absent.token"), BAD_INPUT, "absent.token"),
            (("--token", self.token("operate")), FAILED, "not permitted"),
            (("--token", self.token("publish,watch", "bob")), FAILED, "not permitted"),
            (("--token", expired), FAILED, "expired"))
        with Daemon("--no-render", *self.strict) as daemon:
            for options, code, message in cases:
                for path in ("--udp", "--tcp"):
                    host = daemon.udp if path == "--udp" else daemon.tcp
                    with self.subTest(message, path=path):
                        watched = furrow("watch", host, path, "--subject", "ada", "--wait", *options, check=code)
                        words = watched.stderr.decode()
                        self.assertEqual(words.count("\n"), 1, words)
                        self.assertIn(message, words)
                        played = furrow("play", PERFORMANCE, "--to", host, path, "--subject", "ada", *options)
                        self.assertIn(message, played.stderr.decode())
                        self.assertIn(played.returncode, (code, BAD_INPUT))
            # Also over HTTP.
            for path in ("api/status", "metrics", "weights", "mjpeg"):
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    urllib.request.urlopen(f"http://127.0.0.1:{daemon.ports['http']}/{path}", timeout=GUARD)
                self.assertEqual(refused.exception.code, 401)
                refused.exception.close()
            # The daemon is as it was.
            furrow("watch", daemon.udp, "--subject", "ada", "--wait", "--frames", 1, "--token", self.token("watch"),
                   *self.playing(daemon), check=0)

    def playing(self, daemon):
        """Plays in the background; returns options for `watch`."""
        self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop", "--token", self.token("publish"))
        return SHORT

    def test_clients_come_back_after_a_restart(self):
        publish, watch = self.token("publish"), self.token("watch")
        for path in ("--udp", "--tcp"):
            with self.subTest(path):
                with Killed("--no-render", *self.strict) as daemon:
                    host = daemon.udp if path == "--udp" else daemon.tcp
                    player = self.start("play", PERFORMANCE, "--to", host, path, "--subject", "ada", "--loop", "--token",
                                        publish)
                    watcher = self.start("watch", host, path, "--subject", "ada", "--wait", "--token", watch, *SHORT)
                    rows, notes = Output(watcher.stdout), Output(watcher.stderr)
                    rows_after(rows, 5)
                notes.wait_for(lambda text: LOST in text)
                rows.take()
                with Daemon("--no-render", *self.strict, ports=daemon.ports):
                    rows_after(rows, 20)
                    notes.wait_for(lambda text: "connected again" in text)
                    self.end(watcher)
                    self.end(player)

    def test_keys_are_read_again(self):
        with Daemon("--no-render", *self.strict) as daemon:
            old = furrow("token", "key", "list", "--key", self.keys, check=0).stdout.decode().splitlines()[1].split()[0]
            player = self.start("play", PERFORMANCE, "--to", daemon.udp, "--subject", "ada", "--loop", "--token",
                                self.token("publish"))
            beside = self.start("play", PERFORMANCE, "--to", daemon.tcp, "--tcp", "--subject", "bob", "--loop", "--token",
                                self.token("publish"))
            watcher = self.start("watch", daemon.udp, "--subject", "ada", "--wait", "--token", self.token("watch"), *SHORT)
            rows, notes = Output(watcher.stdout), Output(watcher.stderr)
            rows_after(rows, 5)
            furrow("watch", daemon.udp, "--subject", "bob", "--wait", "--frames", 1, "--token", self.token("watch"), *SHORT,
                   check=0)
            furrow("token", "key", "new", "--key", self.keys, check=0)
            furrow("token", "key", "retire", old, "--key", self.keys, check=0)
            notes.wait_for(lambda text: LOST in text and REFUSED in text)
            Output(player.stderr).wait_for(lambda text: REFUSED in text)
            Output(beside.stderr).wait_for(lambda text: "of the token" in text and "; trying again" in text)
            beside.send_signal(signal.SIGINT)
            self.assertEqual(beside.wait(timeout=GUARD), NO_CONNECTION)
            player.send_signal(signal.SIGINT)
            self.assertEqual(player.wait(timeout=GUARD), NO_CONNECTION)
            furrow("watch", daemon.udp, "--subject", "ada", "--wait", "--frames", 1, "--token", self.token("watch"),
                   *self.playing(daemon), check=0)
            watcher.kill()
            watcher.wait(timeout=GUARD)
        self.assertRegex(daemon.stderr, r"read 1 key from")
        self.assertRegex(daemon.stderr, r"warning ended [12] sessions? over UDP: the keys of their tokens were retired")
        self.assertRegex(daemon.stderr, r"warning refused udp 127\.0\.0\.1: the server does not have the key of the token")

    def test_the_daemon_says_what_is_missing(self):
        for options, code, message in (
                (("--security", "required"), 2, "--keys FILE"),
                (("--security", "required", "--keys", self.root / "absent"), BAD_INPUT, "absent"),
                (("--bind", "0.0.0.0"), 2, "--security required"),
                (("--open", *self.strict), 2, "cannot be combined")):
            with self.assertRaises(AssertionError) as failed:
                with Daemon("--no-render", *options):
                    pass
            self.assertIn(message, str(failed.exception), (options, code))


if __name__ == "__main__":
    unittest.main()
