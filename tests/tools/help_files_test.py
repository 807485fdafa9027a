"""tools/package/help_files.py: completions know every option that --help has, and bash takes them."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/package"))
import help_files  # noqa: E402

VKVOL = str(pathlib.Path(os.environ["VKVOL_BUILD"]) / "vkvol")


class Completions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.commands = {name: help_files.options_of(help_files.help_of(VKVOL, *([] if name == "render" else [name])))
                        for name in help_files.COMMANDS}
        cls.integrators = ["deltaTracking", "ratioTracking"]

    def complete(self, *words):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("cloud.xml", "smoke.nvdb", "a.exr", "notes.txt", "my scene.xml"):
                (pathlib.Path(folder) / name).touch()
            (pathlib.Path(folder) / "my scenes").mkdir()
            script = help_files.bash(self.commands, self.integrators) + (
                'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _vkvol; printf "%s\\n" "${COMPREPLY[@]}"')
            done = subprocess.run(["bash", "-c", script, "bash", *words], cwd=folder, capture_output=True, text=True, check=True)
            self.assertEqual(done.stderr, "")
            return set(done.stdout.splitlines()) - {""}

    def test_every_option_of_help_is_found(self):
        for name, options in self.commands.items():
            text = help_files.help_of(VKVOL, *([] if name == "render" else [name]))
            named = {word.split("=")[0] for line in text.splitlines() if line.startswith("  -") for word in line.split()[0].split(",")}
            self.assertEqual({n for option in options for n in option.names}, named, name)
        shells = {make.__name__: make(self.commands, self.integrators) for make in (help_files.bash, help_files.zsh, help_files.fish)}
        for option in self.commands["render"]:
            for shell, text in shells.items():
                self.assertIn(option.long[2:], text, shell)

    def test_every_command_of_help_is_known(self):
        text = help_files.help_of(VKVOL)
        told = {line.split()[1] for line in text[text.index("Other commands"):].split("\n\n")[0].splitlines()[1:]}
        self.assertEqual(told | {"render"}, set(help_files.COMMANDS))

    def test_bash(self):
        self.assertEqual(self.complete("vkvol", "--no"), {"--noise", "--no-cache"})
        self.assertEqual(self.complete("vkvol", "bench", "--int"), {"--integrators"})
        self.assertEqual(self.complete("vkvol", "cloud.xml", "--tonemap", "a"), {"aces", "agx"})
        self.assertEqual(self.complete("vkvol", "cloud.xml", "--integrator", "ra"), {"ratioTracking"})
        self.assertEqual(self.complete("vkvol", "cloud.xml", "--spp", ""), set())
        self.assertEqual(self.complete("vkvol", "info", ""), {"smoke.nvdb", "my scenes"})
        self.assertEqual(self.complete("vkvol", "compare", ""), {"a.exr", "my scenes"})
        self.assertEqual(self.complete("vkvol", "my"), {"my scene.xml", "my scenes"})
        self.assertEqual(self.complete("vkvol", "cloud.xml", "--report", "my"), {"my scene.xml", "my scenes"})
        self.assertEqual(self.complete("vkvol", "d"), {"devices", "develop", "demo"})
        self.assertEqual(self.complete("vkvol", "cl"), {"cloud.xml"})


if __name__ == "__main__":
    unittest.main()
