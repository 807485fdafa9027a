"""Tests without vkvol, on pictures made here; those that denoise are skipped where pyoidn is not there."""
import contextlib
import io
import struct
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import __main__ as tool
import comparison
import judge
import open_image_denoise
import picture_file
from picture_file import Picture

HEIGHT, WIDTH, SPP = 72, 120, 16
NOISE = 0.2  # of the picture: standard error of the mean


def missing_library():
    """Why nothing can be denoised; None: it can."""
    try:
        open_image_denoise.load()
    except picture_file.Refusal as refusal:
        return str(refusal)
    return None


MISSING = missing_library()
denoises = unittest.skipIf(MISSING, MISSING)


def ramp():
    """[row, column, channel]: from dark to bright, another way in each channel."""
    y, x = np.mgrid[0:1:HEIGHT * 1j, 0:1:WIDTH * 1j]
    return np.stack([0.2 + x, 0.3 + y, 1.5 - 0.5 * (x + y)], axis=2)


def picture_of(color, error=None, spp=SPP, **metadata):
    """A file as vkvol writes it, of a crop window; color and error, its standard error, are [row, column, channel]."""
    height, width = color.shape[:2]
    names = {"vkvol/seed": "1", "vkvol/layers": "depth albedo", "vkvol/sceneHash": "abc", **metadata}
    attributes = {"channels": ("chlist", b""), "compression": ("compression", b"\0"),
                  "dataWindow": ("box2i", struct.pack("<4i", 5, 7, 4 + width, 6 + height)),
                  "displayWindow": ("box2i", struct.pack("<4i", 0, 0, 199, 99)), "lineOrder": ("lineOrder", b"\0"),
                  "pixelAspectRatio": ("float", struct.pack("<f", 1)), "screenWindowCenter": ("v2f", bytes(8)),
                  "screenWindowWidth": ("float", struct.pack("<f", 1)),
                  "samplesPerPixel": ("int", struct.pack("<i", spp)), "vkvol/sampleOffset": ("int", bytes(4)),
                  "renderTimeSeconds": ("float", struct.pack("<f", 2.0)),
                  "an attribute with a long name, to be kept": ("chromaticities", bytes(range(32))),
                  **{name: ("string", text.encode()) for name, text in names.items()}}
    channels = {c: color[..., i].astype("<f4") for i, c in enumerate("RGB")}
    if error is not None:
        channels.update({"variance." + c: (error[..., i] ** 2).astype("<f4") for i, c in enumerate("RGB")})
    channels["samples"] = np.full((height, width), spp, "<u4")
    channels["depth.Z"] = np.linspace(1, 2, height * width, dtype="<f2").reshape(height, width)
    channels.update({"albedo." + c: np.full((height, width), 0.8, "<f4") for c in "RGB"})
    return Picture(attributes, channels)


def noisy_ramp(seed=1, error=NOISE, **metadata):
    """Of normal noise in proportion to what is there."""
    spread = error * ramp()
    return picture_of(ramp() + spread * np.random.default_rng(seed).standard_normal(spread.shape), spread, **metadata)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.noisy = self.folder / "noisy.exr"

    def run_tool(self, *arguments):
        """(exit code, standard output, lines of standard error)."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = tool.main(list(map(str, arguments)))
        return code, out.getvalue(), err.getvalue().splitlines()


class Denoising(Case):
    @denoises
    def test_error_falls(self):
        picture_file.write(self.noisy, noisy_ramp())
        self.assertEqual(self.run_tool(self.noisy)[0], 0)
        before, after = (judge.error_of(picture_file.read(file).stack(), ramp(), 0.0).relmse
                         for file in (self.noisy, self.folder / "noisy.denoised.exr"))
        self.assertAlmostEqual(before / NOISE**2, 1, delta=0.1)  # less EPSILON's share, which is small
        self.assertLess(after, before / 30)

    @denoises
    def test_what_is_kept(self):
        picture_file.write(self.noisy, noisy_ramp(**{"vkvol/biased": "3 paths ended at maxDepth"}))
        bytes_before, before = self.noisy.read_bytes(), picture_file.read(self.noisy)
        self.run_tool(self.noisy)
        after = picture_file.read(self.folder / "noisy.denoised.exr")
        self.assertEqual(self.noisy.read_bytes(), bytes_before)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["noisy.denoised.exr", "noisy.exr"])
        moved = {f"{prefix}{c}": f"{prefix}noisy.{c}" for prefix in ("", "variance.") for c in "RGB"}
        for name, plane in before.channels.items():
            now = after.channels[moved.get(name, name)]
            self.assertEqual((now.dtype, now.tobytes()), (plane.dtype, plane.tobytes()), name)
        self.assertEqual(len(after.channels), len(before.channels) + 3)
        version = struct.unpack("<I", (self.folder / "noisy.denoised.exr").read_bytes()[4:8])[0]
        self.assertEqual(version, 2 | picture_file.LONG_NAMES)  # readers may refuse the long name without
        changed = {name for name in after.attributes if after.attributes[name] != before.attributes.get(name)}
        self.assertEqual(changed, {"channels", "vkvol/layers", "vkvol/biased"})
        self.assertLessEqual(before.attributes.keys(), after.attributes.keys())

    @denoises
    def test_alpha_is_denoised_with_what_it_multiplies(self):
        noisy, random = noisy_ramp(), np.random.default_rng(3)
        noisy.attributes["vkvol/premultiplied"] = ("int", struct.pack("<i", 1))
        noisy.attributes["vkvol/sumVariance"] = ("string", b"1 1 1")
        clean = np.linspace(0.2, 0.8, WIDTH)[None, :].repeat(HEIGHT, axis=0)
        noisy.channels["A"] = (random.binomial(SPP, clean) / SPP).astype("<f4")
        noisy.channels["variance.A"] = np.full((HEIGHT, WIDTH), 0.01, "<f4")
        picture_file.write(self.noisy, noisy)
        self.assertEqual(self.run_tool(self.noisy)[0], 0)
        after = picture_file.read(self.folder / "noisy.denoised.exr")
        error = lambda channel: ((after.channels[channel] - clean) ** 2).mean()
        self.assertLess(error("A"), error("noisy.A") / 10)
        self.assertIn("variance.noisy.A", after.channels)
        self.assertNotIn("variance.A", after.channels)
        self.assertNotIn("vkvol/sumVariance", after.attributes)

    @denoises
    def test_label(self):
        for before, start in (("", "denoised by Open Image Denoise "), ("steps", "steps; denoised by Open Image Denoise ")):
            picture_file.write(self.noisy, noisy_ramp(**{"vkvol/biased": before}))
            code, out, err = self.run_tool(self.noisy)
            after = picture_file.read(self.folder / "noisy.denoised.exr")
            self.assertEqual((code, err), (0, []))
            self.assertTrue(after.text("vkvol/biased").startswith(start), after.text("vkvol/biased"))
            self.assertTrue(after.text("vkvol/biased").endswith(" from colour and albedo"))
            self.assertIn("from colour and albedo", out)
            self.assertEqual(after.text("vkvol/layers"), "depth albedo noisy")

    @denoises
    def test_without_layers(self):
        bare = noisy_ramp()
        bare.channels = {name: bare.channels[name] for name in ("B", "G", "R")}
        del bare.attributes["vkvol/layers"]
        picture_file.write(self.noisy, bare)
        code, out, err = self.run_tool(self.noisy, "--reference", self.noisy)
        self.assertEqual(code, 0)
        self.assertIn("from colour,", out)
        self.assertIn("no variance", out)
        self.assertEqual(len(err), 1)
        self.assertIn("no layer albedo", err[0])

    @denoises
    def test_named_output(self):
        picture_file.write(self.noisy, noisy_ramp())
        self.assertEqual(self.run_tool(self.noisy, "-o", self.noisy)[0], 0)
        code, _, err = self.run_tool(self.noisy)
        self.assertEqual((code, len(err)), (2, 1))
        self.assertIn("denoised already", err[0])

    @denoises
    def test_comparison_is_printed(self):
        picture_file.write(self.noisy, noisy_ramp())
        reference = self.folder / "reference.exr"
        picture_file.write(reference, noisy_ramp(2, NOISE / 32, spp=SPP * 1024, **{"vkvol/seed": "2"}))
        code, out, _ = self.run_tool(self.noisy, "--reference", reference)
        self.assertEqual(code, 0)
        for word in ("relMSE", "RMSE", "noisy, 16 spp", "times the samples", "Rendering took 2 s", "steepest", "mean (red"):
            self.assertIn(word, out)
        self.assertNotIn("shares samples", out)
        self.assertIn("shares samples", self.run_tool(self.noisy, "--reference", self.noisy)[1])


class BrokenInputs(Case):
    def refused(self, words, *arguments):
        before = {file: file.read_bytes() for file in self.folder.iterdir()}
        code, out, err = self.run_tool(*arguments)
        self.assertEqual((code, out, len(err)), (2, "", 1), err)
        self.assertIn(words, err[0])
        self.assertEqual({file: file.read_bytes() for file in self.folder.iterdir()}, before)

    def test_missing(self):
        self.refused("cannot be read: No such file", self.noisy)

    def test_no_exr(self):
        self.noisy.write_text("<options/>")
        self.refused("is no EXR file", self.noisy)

    def test_cut(self):
        picture_file.write(self.noisy, noisy_ramp())
        data = self.noisy.read_bytes()
        for length in (6, 60, 600, len(data) // 2, len(data) - 1):
            self.noisy.write_bytes(data[:length])
            self.refused("is damaged, or not complete", self.noisy)

    def test_not_finite(self):
        for channel in ("G", "variance.B", "albedo.R"):
            broken = noisy_ramp()
            broken.channels[channel][3, 4:6] = np.nan, np.inf
            picture_file.write(self.noisy, broken)
            self.refused("of 2 pixels is not finite", self.noisy)

    def test_no_colour(self):
        broken = noisy_ramp()
        del broken.channels["R"]
        picture_file.write(self.noisy, broken)
        self.refused("R, G and B are needed", self.noisy)

    def test_one_pixel(self):
        picture_file.write(self.noisy, picture_of(np.ones((1, 1, 3))))
        self.refused("is of 1x1 pixels", self.noisy)

    def test_reference(self):
        reference = self.folder / "reference.exr"
        picture_file.write(self.noisy, noisy_ramp())
        self.refused("cannot be read", self.noisy, "--reference", reference)
        picture_file.write(reference, picture_of(np.ones((HEIGHT, WIDTH - 1, 3))))
        self.refused("is not of the size", self.noisy, "--reference", reference)
        self.refused("is the reference", self.noisy, "--reference", reference, "-o", reference)

    def test_outputs(self):
        picture_file.write(self.noisy, noisy_ramp())
        self.refused("does not exist", self.noisy, "-o", self.folder / "no" / "a.exr")
        self.refused("unknown kind of picture", self.noisy, "-o", self.folder / "a.jpg")
        self.refused("is the noisy picture", self.noisy, "-o", self.noisy)
        link = self.folder / "link.exr"
        link.symlink_to(self.noisy)
        self.refused("is the noisy picture", self.noisy, "-o", link)
        self.refused("is named twice", self.noisy, "-o", self.folder / "a.exr", "-o", self.folder / "b.exr", "-o", self.folder / ".." / self.folder.name / "a.exr")
        self.refused("draws PNG", self.noisy, "-o", self.folder / "a.png", "--vkvol", self.folder / "vkvol")

    @denoises
    def test_output_is_a_directory(self):
        picture_file.write(self.noisy, noisy_ramp())
        directory = self.folder / "a.exr"
        directory.mkdir()
        code, _, err = self.run_tool(self.noisy, "-o", directory)
        self.assertEqual((code, len(err)), (2, 1))
        self.assertIn("cannot be written", err[0])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a.exr", "noisy.exr"])


class Judging(unittest.TestCase):
    def test_reference_noise_is_subtracted(self):
        noisy, reference = noisy_ramp(1), noisy_ramp(2, NOISE / 2)
        truth, variance = reference.stack(), reference.stack("variance.")
        expected = float(np.mean((NOISE * ramp()) ** 2))
        self.assertAlmostEqual(judge.error_of(noisy.stack(), truth, variance).mse / expected, 1, delta=0.1)
        self.assertAlmostEqual(judge.error_of(ramp(), truth, variance).mse / expected, 0, delta=0.02)

    def test_harm(self):
        truth, noise = ramp(), np.full((HEIGHT, WIDTH), 3 * 0.05**2)  # 3 channels, each of standard error 0.05
        noisy, denoised = truth + 0.05, truth.copy()
        denoised[:HEIGHT // 2, :WIDTH // 2] += 0.11   # beyond 2 of them
        denoised[HEIGHT // 2:, :WIDTH // 2] += 0.09   # further off than before, but within
        harm = judge.harm_of(noisy, denoised, truth, noise)
        self.assertEqual((harm.worse, harm.visible, harm.even), (0.25, 0.25, 0.0))
        denoised = noisy + 0.0001 * truth             # too little to be seen, where nothing was wrong
        harm = judge.harm_of(noisy, denoised, noisy, 0 * noise)
        self.assertEqual((harm.worse, harm.visible), (1.0, 0.0))
        self.assertEqual(judge.harm_of(noisy, noisy, truth, 0 * noise).worse, 0.0)  # no further off than before

    def test_harm_at_edges(self):
        truth = np.full((HEIGHT, WIDTH, 3), 0.5)
        truth[:, WIDTH // 2:] = 1.0
        denoised = truth.copy()
        denoised[:, WIDTH // 2 - 1:WIDTH // 2 + 1] += 0.2
        harm = judge.harm_of(truth, denoised, truth, np.zeros((HEIGHT, WIDTH)))
        self.assertEqual((harm.edges, harm.rest), (1.0, 0.0))
        self.assertEqual(harm.even, harm.visible)

    def test_larger_variance_holds(self):
        shape = (1, 1, 3)
        noise = judge.noise_between(np.zeros(shape), np.full((1, 1), 16), np.full(shape, 1 / 512), np.full((1, 1), 512))
        self.assertAlmostEqual(noise[0, 0], 3 * (1 / 16 + 1 / 512))

    def test_longer(self):
        self.assertEqual(comparison.longer(0.1, 0.01, 3.0), "10 times the samples, 30 s")
        self.assertIn("unknown", comparison.longer(0.1, -1e-9, 3.0))

    def test_shared_samples(self):
        one, other = noisy_ramp(), noisy_ramp(**{"vkvol/seed": "2"})
        merged = noisy_ramp(**{"vkvol/seed": "", "vkvol/ranges": "7:0-64 1:15-20"})
        self.assertTrue(comparison.share_samples(one, one))
        self.assertTrue(comparison.share_samples(one, merged))
        self.assertFalse(comparison.share_samples(one, other))
        self.assertFalse(comparison.share_samples(one, noisy_ramp(**{"vkvol/ranges": "1:16-20"})))
        self.assertFalse(comparison.share_samples(other, merged))


def main():
    tests = unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])
    result = unittest.TextTestRunner(sys.stdout, verbosity=1).run(tests)
    if MISSING:
        print(f"skipped, what denoises: {MISSING}")
    failed, skipped = len(result.failures) + len(result.errors), len(result.skipped)
    print(f"{result.testsRun - failed - skipped} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0
