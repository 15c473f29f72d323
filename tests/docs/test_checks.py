#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The checks of the documents find what they should, and only that."""
import pathlib
import tempfile
import unittest

import check_commands
import check_english
import check_links
import check_messages
import documents
import http_examples

import cli_reference

HELP = """Sends a recording
Usage: furrow play [OPTIONS] FILE

Positionals:
  FILE TEXT REQUIRED          A recording

Options:
  -h,--help                   Print this help message and exit
  --to TEXT REQUIRED          HOST of furrowd
  --udp Excludes: --tcp       Send datagrams
  --speed FLOAT:FLOAT in [0.001 - 1000]=1
                              How many times as fast as recorded,
                              or as slow
[Option Group: where]
  Where the patch is
  Options:
    --joint TEXT                Where this joint starts

Exit codes: 0 done.
"""


class HelpTest(unittest.TestCase):
    def setUp(self):
        self.help = cli_reference.parse(["furrow", "play"], HELP)

    def test_entries(self):
        self.assertEqual([entry.name for entry in self.help.entries("Positionals")], ["FILE TEXT REQUIRED"])
        self.assertEqual(set(self.help.flags), {"-h", "--help", "--to", "--udp", "--speed", "--joint"})
        self.assertTrue(self.help.flags["--speed"])
        self.assertFalse(self.help.flags["--udp"])

    def test_a_description_may_take_several_lines(self):
        speed = self.help.entries("Options")[-1]
        self.assertEqual(speed.text, "How many times as fast as recorded, or as slow")
        self.assertEqual(cli_reference.bare(speed.name), "--speed FLOAT")
        self.assertEqual(cli_reference.constraint(speed.name), "range: 0.001 to 1000; default: 1")

    def test_footer(self):
        self.assertEqual(self.help.footer, ["Exit codes: 0 done."])


class CommandTest(unittest.TestCase):
    def setUp(self):
        top = cli_reference.parse(["furrow"], "Top\nUsage: furrow SUBCOMMAND\n\nSubcommands:\n  play    Sends\n")
        self.helps = {"furrow": top, "furrow play": cli_reference.parse(["furrow", "play"], HELP)}

    def faults(self, text):
        return check_commands.check_page("page.md", text, self.helps)

    def test_good_commands(self):
        self.assertEqual(self.faults("```sh\nfurrow play a.bvh --to localhost | head  # --nothing\n```\n`furrow play`"), [])

    def test_unknown_option(self):
        self.assertEqual(self.faults("```sh\n\n$ furrow play a --to b \\\n  --fast\n```"),
                         ["page.md:3: furrow play has no option --fast"])

    def test_unknown_command_in_a_sentence(self):
        self.assertEqual(len(self.faults("Run `furrow dance`.")), 1)

    def test_missing_required_option(self):
        self.assertEqual(len(self.faults("```\nfurrow play a.bvh\n```")), 1)

    def test_other_languages_are_no_commands(self):
        self.assertEqual(self.faults("```text\nfurrow dance --fast\n```"), [])


class BlockTest(unittest.TestCase):
    def test_marker_and_redirection(self):
        (block,) = documents.blocks("<!-- runs -->\n```sh\nfurrow solve a > b.csv\n```\n")
        self.assertEqual(block.marker, "runs")
        (line,) = documents.command_lines(block)
        self.assertEqual((line.words, line.output), (["furrow", "solve", "a"], "b.csv"))


class LinkTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()

    def test_tree(self):
        (self.root / "a.md").write_text("# One `two`\n[x](b.md#there) [y](c.md) [z](#one-two) `[q](d.md)`\n"
                                        "```\n[in code](e.md)\n```\n![no picture](p.png)\n")
        (self.root / "b.md").write_text("# Elsewhere\n")
        self.assertEqual(check_links.check_tree(self.root),
                         ["a.md:2: link to a missing heading: b.md#there", "a.md:2: link to a missing file: c.md",
                          "a.md:6: link to a missing file: p.png"])

    def test_site(self):
        (self.root / "index.html").write_text('<script src="https://cdn.example/x.js"></script>'
                                              '<h1 id="top"></h1><a href="#top"></a><a href="#bottom"></a>')
        self.assertEqual(check_links.check_site(self.root),
                         ["index.html: loads from another host: https://cdn.example/x.js",
                          "index.html: link to a missing anchor: #bottom"])


class EnglishTest(unittest.TestCase):
    def test_patterns(self):
        for line in ("// Who watches sees it.", "what cannot be had", "// It is told of it.", "- Whoever comes",
                     "there are so many of them"):
            self.assertTrue(check_english.matches(line), line)
        for line in ("// Who sends it, and is it new?", "// The hub is no longer needed.", "// If there is no hub, do nothing.",
                     "int what = 0;"):
            self.assertFalse(check_english.matches(line), line)


class MessageTest(unittest.TestCase):
    def test_parts(self):
        self.assertEqual(check_messages.parts("subject '<name>' fell silent and <x> it"), ["fell silent and"])


class ShapeTest(unittest.TestCase):
    def test_differences(self):
        self.assertEqual(http_examples.differences({"a": 1, "b": [{"c": ""}]}, {"a": 2.5, "b": [{"c": "x"}]}), [])
        self.assertEqual(len(http_examples.differences({"a": 1}, {"a": "1"})), 1)
        self.assertEqual(len(http_examples.differences({"a": 1}, {"b": 1})), 2)
        self.assertEqual(len(http_examples.differences({"version": "1"}, {"version": "2"})), 1)
        self.assertEqual(http_examples.differences({"a": None}, {"a": {"b": 1}}), [])


if __name__ == "__main__":
    unittest.main()
