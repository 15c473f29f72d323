#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Skeletons with other joint names: which map a command used, proposed maps, and roles that packages keep."""
import json
import pathlib
import struct
import tempfile
import unittest

from body_testing import CESIUM_MAN, PERSON, TIMES, VRM, Body, kick, rotate, turn
from furrow_testing import Daemon, SHARE, Table, differing_share, finish, furrow, solve, spawn_watch, worst_difference
from test_foreign_bodies import JOINTS, bvh

DONE, BAD_INPUT = 0, 3
PERFORMANCE = SHARE / "recordings" / "performance.bvh"
RIG = SHARE / "default.rig.json"
# Names that tell nothing, and one leg that is longer than the other: neither a shipped map nor the hierarchy
# tells the roles.
LAME = (*PERSON, ("claw_l", "toes_l", (0.1, 0.02, 0.5)))
NUMBERED = {part: f"ctl_{i}" for i, (part, *_) in enumerate(LAME)}


def lines(result, word="skeleton map"):
    return [line for line in result.stderr.decode().splitlines() if word in line]


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def import_body(self, body, name, *options):
        package = self.root / f"{name}_package.glb"
        furrow("character", "import", body.save(self.root / f"{name}.glb"), "--out", package, *options, check=DONE)
        return package

    def pictures(self, recording, character, name, *options):
        furrow("render", recording, "--character", character, "--camera", "body", "--size", "96x96", "--out",
               self.root / name, *options, check=DONE)
        return [path.read_bytes() for path in sorted((self.root / name).iterdir())]


class FitTest(FolderTest):
    """Every command that reads joints says in one line which map it used, and how well the map fits."""

    def setUp(self):
        super().setUp()
        self.walk = self.root / "walk.bvh"
        self.walk.write_text(bvh(JOINTS))
        self.trunk = self.root / "trunk.json"
        self.trunk.write_text(json.dumps({"version": 1, "name": "trunk", "joints": {
            "hips": "Hips", "spine": ["LowerBack", "Spine"], "chest": "Spine1", "neck": ["Neck", "Neck1"],
            "head": "Head"}}))

    def commands(self):
        yield "solve", self.walk, "--rig", RIG, "--allow-missing"
        yield "rig", "check", "default", "--skeleton", self.walk
        yield "rig", "explain", "default", self.walk
        yield "convert", self.walk, self.root / "walk.glb"
        yield "convert", self.walk, self.root / "walk.mcap"
        yield "render", self.walk, "--frames", "0", "--size", "64x64", "--out", self.root / "shots"
        yield "render", self.walk, "--frames", "0", "--size", "64x64", "--subjects", "3", "--out", self.root / "shots"

    def test_every_command_says_the_map_once(self):
        for command in self.commands():
            with self.subTest(command[0]):
                said = lines(furrow(*command))
                self.assertEqual(len(said), 1, said)
                self.assertRegex(said[0], r"^furrow: skeleton map 'cmu': 20 roles, 21 of 21 joints; missing: leftToes")
        self.assertIn("skeleton map 'cmu': 20 roles", furrow("info", self.walk, check=DONE).stdout.decode())

    def test_play_and_the_daemon_agree(self):
        take = self.root / "walk.mcap"
        furrow("convert", self.walk, take, check=DONE)
        with Daemon("--no-render") as daemon:
            for recording in (self.walk, take):
                played = lines(furrow("play", recording, "--to", daemon.tcp, "--tcp", check=DONE))
                self.assertEqual(len(played), 1, played)
        self.assertIn(played[0].removeprefix("furrow: "), daemon.stderr)

    def test_a_recording_of_the_default_character_gives_one_line(self):
        said = furrow("solve", PERFORMANCE, "--rig", RIG, check=DONE).stderr.decode().splitlines()
        self.assertEqual(len(said), 1, said)
        self.assertRegex(said[0], r"^furrow: skeleton map 'default': \d+ roles, \d+ of \d+ joints; missing: upperChest$")
        posed = furrow("render", "--pose", "neutral", "--size", "64x64", "--out", self.root / "shots", check=DONE)
        self.assertEqual(posed.stderr, b"")

    def test_unknown_skeletons_are_named(self):
        box = self.root / "box.bvh"
        box.write_text(bvh((("box", None, (0, 1, 0)), ("lid", "box", (0, 1, 0)))))
        for result in (furrow("convert", box, self.root / "box.glb", check=DONE),
                       furrow("solve", box, "--rig", RIG, "--allow-missing", check=DONE)):
            self.assertEqual(lines(result), ["furrow: no skeleton map fits, so joints are matched by equal names (--skeleton-map chooses one)"])
        self.assertIn("joints      no skeleton map fits", furrow("info", box, check=DONE).stdout.decode())

    def test_a_bad_fit_is_a_warning_with_the_way_out(self):
        commands = [command for command in self.commands() if command[0] != "convert"]
        for command in commands:
            with self.subTest(command[0]):
                said = lines(furrow(*command, "--skeleton-map", self.trunk))
                self.assertEqual(len(said), 2, said)
                self.assertIn("skeleton map 'trunk': 5 roles, 7 of 21 joints", said[0])
                self.assertRegex(said[1], r"furrow: warning: skeleton map 'trunk' gives no role to \d+ joints of "
                                 r"trunk and limbs \(\w+, .*\.\.\.\), and these roles are missing: leftUpperArm, .*; "
                                 r"choose another map with --skeleton-map, or write one with 'furrow rig propose-map'")
        nothing = furrow("solve", self.walk, "--rig", RIG, "--allow-missing", "--skeleton-map", "vroid", check=DONE)
        self.assertIn("skeleton map 'vroid' knows none of the 21 joints", nothing.stderr.decode())
        with Daemon("--no-render", "--skeleton-map", self.trunk) as daemon:
            furrow("play", self.walk, "--to", daemon.tcp, "--tcp", check=DONE)
        self.assertIn("skeleton map 'trunk' gives no role to", daemon.stderr)


class CesiumManTest(FolderTest):
    """A body whose joints no map knows, Z up and facing +X, as Khronos's sample CesiumMan."""

    def setUp(self):
        super().setUp()
        self.man = Body(CESIUM_MAN, z_up=True, moves=kick())

    def test_it_plays_its_own_animation(self):
        package = self.import_body(self.man, "man")
        # The same body with names that a map knows is the reference.
        known = self.import_body(Body(VRM, z_up=True, moves=kick()), "known")
        recording = self.root / "man.glb"
        weights = solve(recording, "--rig", package, "--drivers", "--no-filter")
        self.assertEqual(worst_difference(weights, solve(self.root / "known.glb", "--rig", known, "--drivers",
                                                         "--no-filter")), (0, len(TIMES)))
        knee, other = weights.column("knee_l.flexed"), weights.column("knee_r.flexed")
        self.assertGreater(knee[2], 0.2)
        self.assertAlmostEqual(knee[0], knee[4], places=5)
        self.assertLess(max(other.values()), 0.01)
        drawn = self.pictures(recording, package, "shots")
        expected = self.pictures(self.root / "known.glb", known, "expected")
        self.assertEqual(len(drawn), len(TIMES))
        for a, b in zip(drawn, expected):
            self.assertLess(differing_share(a, b), 1e-3)
        self.assertGreater(differing_share(drawn[0], drawn[2]), 0.01)

    def test_others_move_it(self):
        # Without the names of a map, its rig finds the joints of other recordings by the roles of the package.
        package = self.import_body(self.man, "man")
        other = Body(VRM, moves=kick()).save(self.root / "other.glb")
        own = solve(self.root / "man.glb", "--rig", package, "--drivers", "--no-filter")
        seen = solve(other, "--rig", package, "--drivers", "--no-filter")
        self.assertLess(worst_difference(own, seen)[0], 1e-3)

    def test_a_proposed_map_is_a_start(self):
        man = self.man.save(self.root / "man.glb")
        mine = self.root / "mine.json"
        said = furrow("rig", "propose-map", man, "--out", mine, check=DONE).stderr.decode()
        self.assertIn("guessed from the hierarchy: 19 roles, 19 of 21 joints; check the joints", said)
        written = json.loads(mine.read_text())
        self.assertEqual((written["version"], written["name"]), (1, "mine"))
        self.assertEqual(written["joints"]["hips"], CESIUM_MAN["hips"])
        self.assertEqual(written["joints"]["leftUpperLeg"], CESIUM_MAN["leg_l"])
        self.assertEqual(written["joints"]["rightLowerArm"], CESIUM_MAN["elbow_r"])
        rig = ("--rig", RIG, "--allow-missing", "--drivers", "--no-filter")
        guessed = furrow("solve", man, *rig, check=DONE)
        self.assertIn("their roles are guessed from the hierarchy", guessed.stderr.decode())
        mapped = furrow("solve", man, *rig, "--skeleton-map", mine, check=DONE)
        self.assertIn("skeleton map 'mine': 19 roles", mapped.stderr.decode())
        self.assertNotIn("guessed", mapped.stderr.decode())
        self.assertEqual(mapped.stdout, guessed.stdout)
        self.assertGreater(Table(mapped.stdout.decode()).column("knee_l.flexed")[2], 0.2)
        # A fox has no roles to propose.
        fox = Body(parts=FOX, moves=TROT).save(self.root / "fox.glb")
        message = furrow("rig", "propose-map", fox, "--out", self.root / "none.json", check=BAD_INPUT).stderr.decode()
        self.assertIn("no roles were found", message)
        self.assertFalse((self.root / "none.json").exists())


class PackageTest(FolderTest):
    """What the import found or was told, the package keeps."""

    def setUp(self):
        super().setUp()
        roles = {"hips": "hips", "spine": "spine", "chest": "chest", "neck": "neck", "head": "head",
                 **{f"{side}{role}": f"{part}_{side[0]}" for side in ("left", "right")
                    for part, role in (("arm", "UpperArm"), ("elbow", "LowerArm"), ("hand", "Hand"),
                                       ("leg", "UpperLeg"), ("knee", "LowerLeg"), ("foot", "Foot"), ("toes", "Toes"))}}
        # Of the character, and of the recording: a chosen map replaces all others.
        self.mine = self.root / "mine.json"
        self.mine.write_text(json.dumps({"version": 1, "name": "mine", "joints": {
            role: f"{NUMBERED[part]}|{VRM[part]}" for role, part in roles.items()}}))
        self.body = Body(NUMBERED, parts=LAME, moves=kick())
        self.package = self.import_body(self.body, "lame", "--map", self.mine)
        self.recording = Body(VRM, moves=kick()).save(self.root / "vrm.glb")

    def test_render_and_solve_need_no_map(self):
        solve_it = lambda *options: furrow("solve", self.recording, "--rig", self.package, *options, check=DONE).stdout
        self.assertEqual(solve_it(), solve_it("--skeleton-map", self.mine))
        self.assertGreater(max(Table(solve_it("--drivers").decode()).column("knee_l.flexed").values()), 0.2)
        drawn = self.pictures(self.recording, self.package, "without")
        self.assertEqual(drawn, self.pictures(self.recording, self.package, "with", "--skeleton-map", self.mine))
        self.assertGreater(differing_share(drawn[0], drawn[2]), 0.01)

    def test_its_own_animation_follows_the_same_roles(self):
        own = self.root / "lame.glb"
        result = furrow("solve", own, "--rig", self.package, check=DONE)
        self.assertEqual(lines(result, "joint"),
                         ["furrow: joint roles of the character's package: 19 roles, 19 of 21 joints"])
        self.assertEqual(result.stdout, furrow("solve", own, "--rig", self.package, "--skeleton-map", self.mine,
                                               check=DONE).stdout)

    def test_the_daemon_needs_no_map_with_and_without_pictures(self):
        expected = solve(self.recording, "--rig", self.package)
        for args in (("--no-render",), ()):
            with self.subTest(args), Daemon("--character", self.package, *args) as daemon:
                watcher = spawn_watch(daemon.tcp, "ada")
                furrow("play", self.recording, "--to", daemon.tcp, "--tcp", "--subject", "ada", check=DONE)
                seen = Table(finish(watcher)[1].decode())
                worst, frames = worst_difference(seen, expected)
                self.assertGreater(frames, 0)
                self.assertLess(worst, 1e-3)
            self.assertNotIn("lacks joints", daemon.stderr)

    def test_a_second_import_and_the_check_keep_them(self):
        report = json.loads(furrow("character", "check", self.package, "--json", check=DONE).stdout)
        self.assertEqual((report["skeleton_map"], report["roles"]), ("(package)", 19))
        again = self.root / "again.glb"
        furrow("character", "import", self.package, "--out", again, check=DONE)
        self.assertEqual(solve(self.recording, "--rig", again).rows, solve(self.recording, "--rig", self.package).rows)

    def test_old_packages_and_odd_roles(self):
        data = self.package.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        root = json.loads(data[20:20 + length])

        def write(change):
            for node in root["nodes"]:
                change(node.get("extras", {}))
            text = json.dumps(root).encode()
            text += b" " * (-len(text) % 4)
            rest = data[20 + length:]
            path = self.root / "odd.glb"
            path.write_bytes(b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(rest)) +
                             struct.pack("<I", len(text)) + b"JSON" + text + rest)
            (self.root / "odd.rig.json").write_bytes(self.package.with_suffix(".rig.json").read_bytes())
            return path

        for role in ("elbow", 9, "x" * 100000, ["hips"]):
            odd = write(lambda extras: extras.update(furrow_role=role) if "furrow_role" in extras else None)
            for command in (("solve", self.recording, "--rig", odd),
                            ("render", self.recording, "--character", odd, "--out", self.root / "none")):
                message = furrow(*command, check=BAD_INPUT).stderr.decode()
                self.assertRegex(message, r"odd\.glb: nodes\[\d+\]\.extras\.furrow_role: ")
                self.assertEqual(message.count("\n"), 1, message)
        # A package without roles works as it did: with a map.
        old = write(lambda extras: extras.pop("furrow_role", None))
        message = furrow("solve", self.recording, "--rig", old, check=BAD_INPUT).stderr.decode()
        self.assertIn("ctl_", message)
        self.assertEqual(furrow("solve", self.recording, "--rig", old, "--skeleton-map", self.mine, check=DONE).stdout,
                         furrow("solve", self.recording, "--rig", self.package, check=DONE).stdout)


# The joints of a fox: a spine along +Z with legs across it.
FOX = (("Hip", None, (0, 0.45, -0.3)), ("Spine01", "Hip", (0, 0.47, 0)), ("Spine02", "Spine01", (0, 0.47, 0.3)),
       ("Neck", "Spine02", (0, 0.6, 0.42)), ("Head", "Neck", (0, 0.68, 0.5)), ("Tail", "Hip", (0, 0.45, -0.5)),
       *((f"{leg}{i}_{side}", "Hip" if (leg, i) == ("Back", 1) else "Spine02" if i == 1 else f"{leg}{i - 1}_{side}",
          (sign * 0.1, y, z))
         for side, sign in (("L", 1), ("R", -1)) for leg, z in (("Front", 0.3), ("Back", -0.3))
         for i, y in ((1, 0.42), (2, 0.22), (3, 0.04))))
TROT = {"Front2_L": [turn((1, 0, 0), 40 * s) for s in (0, 0.5, 1, 0.5, 0)]}


class FoxTest(FolderTest):
    def test_a_fox_is_not_stood_upright(self):
        fox = Body(parts=FOX, moves=TROT)
        package = self.import_body(fox, "fox", "--scale", "1")
        data = package.read_bytes()
        nodes = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])["nodes"]
        places = {}

        def place(index, turned, origin):
            node = nodes[index]
            at = [o + d for o, d in zip(origin, rotate(turned, node.get("translation", (0, 0, 0))))]
            self.assertLess(max(abs(x) for x in node.get("rotation", (0, 0, 0, 1))[:3]), 1e-5, node["name"])
            places[node["name"]] = at
            for child in node.get("children", ()):
                place(child, turned, at)

        roots = set(range(len(nodes))) - {child for node in nodes for child in node.get("children", ())}
        for root in roots:
            place(root, (0, 0, 0, 1), (0, 0, 0))
        for part, _, expected in FOX:
            for axis in range(3):
                self.assertAlmostEqual(places[part][axis], expected[axis], places=4, msg=part)
        # It plays its own animation by equal names.
        result = furrow("render", self.root / "fox.glb", "--character", package, "--size", "96x96", "--out",
                        self.root / "shots", check=DONE)
        said = lines(result, "equal names")
        self.assertEqual(len(said), 1, result.stderr)
        self.assertRegex(said[0], r"^furrow: joints are matched by equal names: (\d+) of \1 joints$")
        self.assertEqual(lines(result), [])
        shots = [path.read_bytes() for path in sorted((self.root / "shots").iterdir())]
        self.assertEqual(len(shots), len(TIMES))


if __name__ == "__main__":
    unittest.main()
