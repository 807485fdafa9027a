"""The farm's scripts beside stand-ins for sbatch and vkvol; tools/farm/farm_check.sh has them run by the real ones."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

FARM = pathlib.Path(__file__).resolve().parents[2] / "tools/farm"


class FarmTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="farm with spaces ")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.xml").write_text("<options/>")
        # Keeps what it is given, and tells a cluster's name behind the number.
        self.program("sbatch", 'echo "$*" >>log; cat >>log; echo "7;cluster"')
        self.program("vkvol", 'while [ $# -gt 0 ]; do [ "$1" != -o ] || echo picture >"$2"; shift; done')

    def program(self, name, text):
        file = self.folder / name
        file.write_text(f"#!/bin/bash\n{text}\n")
        file.chmod(0o755)

    def run_script(self, name, *arguments):
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}", "VKVOL": str(self.folder / "vkvol")}
        return subprocess.run(["bash", FARM / name, *arguments], cwd=self.folder, env=environment, capture_output=True, text=True)

    def test_files_that_all_parts_would_write_are_refused(self):
        for argument in ("-o", "-oall.exr", "--output=all.exr", "--report"):
            done = self.run_script("render_part.sh", "scene.xml", "still", "1", "2", "a", argument, "all.exr")
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{argument}: all parts would write the same file", done.stderr)

    def test_no_checkpoint_outlives_a_part(self):
        (self.folder / "a.still.1-of-2.partial.checkpoint").write_text("of a render that --time ended")
        self.assertEqual(self.run_script("render_part.sh", "scene.xml", "still", "1", "2", "a", "--time", "1").returncode, 0)
        self.assertFalse((self.folder / "a.still.1-of-2.partial.checkpoint").exists())

    def frames_of(self, text):
        (self.folder / "log").unlink(missing_ok=True)
        done = self.run_script("slurm.sh", "scene.xml", text, "2", "out/100 %/a", "--spp", "4")
        self.assertEqual(done.returncode, 0, done.stderr)
        log = (self.folder / "log").read_text()
        self.assertIn("--dependency=afterok:7 ", log)
        self.assertIn("--output=out/100 %%/a.%a.log", log)
        frames = re.search(r"frames=\((.*)\)", log)[1].split()
        self.assertIn(f"--array=0-{2 * len(frames) - 1}", log)
        self.assertIn(f"for frame in {' '.join(frames)};", log)
        return frames

    def test_frames(self):
        for text, frames in (("1,5,9", "1 5 9"), ("008-010", "8 9 10"), ("1-9:4,12", "1 5 9 12"), ("1-5,3", "1 2 3 4 5"), ("3", "3"), ("still", "still")):
            with self.subTest(frames=text):
                self.assertEqual(self.frames_of(text), frames.split())
        self.assertTrue((self.folder / "out/100 %").is_dir())  # into which logs are written
        for wrong in ("", "a", "5-1", "1-3:0", "1,,2", "1-"):
            with self.subTest(frames=wrong):
                self.assertEqual(self.run_script("slurm.sh", "scene.xml", wrong, "2", "a").returncode, 2)

    def test_parts_of_other_requests_are_not_taken(self):
        part = ("render_part.sh", "scene.xml", "still", "1", "2", "out/a")
        self.assertEqual(self.run_script(*part, "--spp", "4").returncode, 0)
        self.assertIn("is there", self.run_script(*part, "--spp", "4").stdout)
        other = self.run_script(*part, "--spp", "5")
        self.assertEqual(other.returncode, 2)
        self.assertIn("is of another scene or other arguments", other.stderr)
        (self.folder / "scene.xml").write_text("<options></options>")
        self.assertEqual(self.run_script(*part, "--spp", "4").returncode, 2)

    def test_parts_begun_by_others_begin_anew(self):
        part = ("render_part.sh", "scene.xml", "still", "1", "2", "out/a")
        checkpoint = self.folder / "out/a.still.1-of-2.partial.checkpoint"
        checkpoint.parent.mkdir()
        checkpoint.write_text("of another device")
        refused = ("is of another device", "has 500 samples per pixel already, more than the 256 asked for")
        self.program("vkvol", 'echo "vkvol: error: a.nvdb: cannot be opened" >&2; exit 2')  # whatever it begins from
        self.assertEqual(self.run_script(*part).returncode, 2)
        self.assertEqual(checkpoint.read_text(), "of another device")
        for why in refused:
            checkpoint.write_text("of another render")
            self.program("vkvol", f'[ -f "{checkpoint}" ] && echo "--resume: the checkpoint {why}" >&2 && exit 2; while [ $# -gt 0 ]; do [ "$1" != -o ] || echo picture >"$2"; shift; done')
            self.assertEqual(self.run_script(*part).returncode, 0)
            self.assertEqual([file.name for file in checkpoint.parent.glob("*partial*")], [])
            (checkpoint.parent / "a.still.1-of-2.exr").unlink()

    def test_strict_parts_fail_and_are_rendered_once(self):
        self.program("vkvol", 'echo run >>runs; while [ $# -gt 0 ]; do [ "$1" != -o ] || echo picture >"$2"; shift; done; exit 5')
        for _ in range(2):
            self.assertEqual(self.run_script("render_part.sh", "scene.xml", "still", "1", "2", "out/a", "--strict").returncode, 5)
        self.assertEqual((self.folder / "runs").read_text(), "run\n")
        self.assertTrue((self.folder / "out/a.still.1-of-2.exr").exists())


if __name__ == "__main__":
    unittest.main()
