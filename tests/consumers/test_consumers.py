#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Furrow as others use it: installed, moved, linked in four ways, and asked for weights.

Needs the environment that CMakeLists.txt sets: FURROW_BUILD, a complete build, and FURROW_SOURCE.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["FURROW_BUILD"])
SOURCE = pathlib.Path(os.environ["FURROW_SOURCE"])
PROJECTS = SOURCE / "tests" / "consumers"
GUARD = 600  # seconds; only a failing test takes this long
SKIPPED = 77


def run(*command, env=None, cwd=None, check=True):
    """Runs a command and returns its standard output; a failure shows everything that it printed."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=GUARD, cwd=cwd,
                          env={**os.environ, **(env or {})}, check=False)
    if check and done.returncode != 0:
        raise AssertionError(f"{shlex.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    """An installation that was moved, with its daemon and a performer."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-consumers-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        first = cls.folder / "first"
        run("cmake", "--install", BUILD, "--prefix", first)
        cls.prefix = cls.folder / "moved" / "furrow"
        cls.prefix.parent.mkdir()
        first.rename(cls.prefix)
        libraries = [path.parent for path in cls.prefix.rglob("libfurrow.so.1")]
        assert len(libraries) == 1, libraries
        cls.env = {"LD_LIBRARY_PATH": str(libraries[0]), "PKG_CONFIG_PATH": str(libraries[0] / "pkgconfig")}
        cls.start_daemon()

    @classmethod
    def start_daemon(cls):
        """The installed daemon with its default character, and a performer from the installed recordings."""
        without = {name: value for name, value in os.environ.items() if not name.startswith("FURROW_")}
        daemon = subprocess.Popen(
            [cls.prefix / "bin" / "furrowd", "--no-render", "--tcp", "0", "--udp", "0", "--http", "0"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=cls.folder, env=without)
        cls.addClassCleanup(cls.stop, daemon)
        ready = daemon.stdout.readline()
        cls.ports = {name: port for name, port in re.findall(r"(\w+)=[^ ]*?:(\d+)", ready)}
        assert "udp" in cls.ports, f"the installed daemon did not start: {ready}"
        recording = cls.prefix / "share" / "furrow" / "recordings" / "performance.bvh"
        performer = subprocess.Popen(
            [cls.prefix / "bin" / "furrow", "play", recording, "--to", f"127.0.0.1:{cls.ports['udp']}", "--subject",
             "ada", "--loop"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=cls.folder, env=without)
        cls.addClassCleanup(cls.stop, performer)

    @staticmethod
    def stop(process):
        process.terminate()
        process.wait(timeout=GUARD)
        if process.stdout:
            process.stdout.close()

    def assert_receives_weights(self, *program):
        """Runs a consumer over UDP and TCP; it prints the names and values that it received."""
        for transport in ("udp", "tcp"):
            address = (f"furrow://127.0.0.1:{self.ports[transport]}?transport={transport}&subject=ada&pattern=brow_*")
            lines = run(*program, address, env=self.env).splitlines()
            self.assertGreater(len(lines), 3)
            for line in lines:
                self.assertRegex(line, r"^brow_\w+\.\w+ [01]\.\d{3}$")

    def configure(self, project, *options):
        build = self.folder / f"build-{project}"
        run("cmake", "-S", PROJECTS / project, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", *options)
        run("cmake", "--build", build, "-j", str(os.cpu_count()))
        return build

    def test_plain_c_by_pkg_config(self):
        flags = shlex.split(run("pkg-config", "--cflags", "--libs", "furrow", env=self.env))
        program = self.folder / "watch-c"
        compiler = os.environ.get("CC", "cc")
        run(compiler, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wno-missing-field-initializers", "-Werror",
            PROJECTS / "plain_c" / "watch.c", "-o", program, *flags)
        self.assert_receives_weights(program)

    def test_cpp17_by_find_package(self):
        build = self.configure("find_package", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.assert_receives_weights(build / "watch")

    def test_c_by_add_subdirectory(self):
        build = self.configure("subdirectory", f"-DFURROW_SOURCE={SOURCE}")
        self.assert_receives_weights(build / "watch")
        self.assertEqual(list(build.rglob("*test_*")), [], "Furrow's tests are not the consumer's")

    def test_cpp17_by_fetch_content(self):
        build = self.configure("fetch_content", f"-DFETCHCONTENT_SOURCE_DIR_FURROW={SOURCE}")
        self.assert_receives_weights(build / "watch")

    def test_installed_programs_find_their_parts(self):
        furrow = self.prefix / "bin" / "furrow"
        self.assertIn("bake", run(furrow, "bake", "--help"), "a helper program in libexec")
        self.assertIn("brow_l", run(furrow, "rig", "check", "default"), "a rig in share")
        # The helper program reads pictures with the module in lib/furrow.
        character = self.prefix / "share" / "furrow" / "default.glb"
        self.assertNotIn("cannot be read", run(furrow, "character", "check", character))

    def test_nothing_names_a_folder_of_the_build(self):
        texts = [path for path in self.prefix.rglob("*") if path.suffix in {".cmake", ".pc", ".h", ".hpp"}]
        self.assertGreater(len(texts), 5)
        for path in texts:
            for folder in (SOURCE, BUILD, self.folder):
                self.assertNotIn(str(folder), path.read_text(), path)

    def test_components_are_separate(self):
        runtime, development = self.folder / "runtime", self.folder / "development"
        run("cmake", "--install", BUILD, "--prefix", runtime, "--component", "runtime")
        run("cmake", "--install", BUILD, "--prefix", development, "--component", "development")
        names = {folder: {path.name for path in folder.rglob("*") if not path.is_dir()}
                 for folder in (runtime, development)}
        for name in ("furrow", "furrowd", "libfurrow.so.1", "default.glb", "furrow-watch.1"):
            self.assertIn(name, names[runtime])
            self.assertNotIn(name, names[development])
        for name in ("furrow.h", "furrow.hpp", "libfurrow.so", "furrow.pc", "FurrowConfig.cmake", "blender_manifest.toml",
                     "furrow_client.gd", "package.json", "Furrow.uplugin"):
            self.assertIn(name, names[development])
            self.assertNotIn(name, names[runtime])


if __name__ == "__main__":
    if os.environ.get("FURROW_SANITIZE"):
        print("SKIPPED: an ordinary program cannot load a library that was built with sanitizers")
        sys.exit(SKIPPED)
    unittest.main()
