#!/usr/bin/env python3
"""Tests of the page that tools/report writes: its pictures, its structure, its colours."""
import re
import struct
import subprocess
import sys
import unittest
import xml.etree.ElementTree as xml
import zlib
from pathlib import Path

import numpy

import report_data as made

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from report_page import palette, picture  # noqa: E402
from report_page.exr import BadPicture, read_exr  # noqa: E402


def exr_of(pixels, compression):
    """A file of three float channels, as the format's description has it."""
    height, width = pixels.shape[:2]
    channels = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + b"".join(
        name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data
        for name, kind, data in ((b"channels", b"chlist", channels), (b"compression", b"compression", bytes([compression])),
                                 (b"dataWindow", b"box2i", box))) + b"\0"
    lines, blocks = {0: 1, 3: 16}[compression], []
    for y in range(0, height, lines):
        raw = b"".join(row[:, c].astype("<f4").tobytes() for row in pixels[y:y + lines] for c in (2, 1, 0))
        if compression:
            halves = numpy.frombuffer(raw[0::2] + raw[1::2], numpy.uint8).astype(int)
            packed = zlib.compress(numpy.concatenate([halves[:1], (numpy.diff(halves) + 128) % 256]).astype(numpy.uint8).tobytes())
            raw = packed if len(packed) < len(raw) else raw
        blocks.append(struct.pack("<ii", y, len(raw)) + raw)
    starts = numpy.cumsum([len(head) + 8 * len(blocks)] + [len(b) for b in blocks[:-1]])
    return head + struct.pack(f"<{len(blocks)}Q", *map(int, starts)) + b"".join(blocks)


class Pictures(made.Folder):
    def test_exr_files_are_read_as_written(self):
        pixels = numpy.random.default_rng(1).random((37, 23, 3)).astype(numpy.float32).round(2)
        for compression in (0, 3):
            file = Path(self.folder.name) / "a.exr"
            file.write_bytes(exr_of(pixels, compression))
            self.assertTrue(numpy.array_equal(read_exr(file), pixels))
        for damaged in (b"", b"no picture", file.read_bytes()[:300], file.read_bytes()[:-40]):
            file.write_bytes(damaged)
            self.assertRaises(BadPicture, read_exr, file)

    def test_the_error_picture_adds_up_to_relmse(self):
        reference = numpy.full((4, 4, 3), 0.3)
        _, relmse = picture.error_picture(reference + 0.1, reference)
        self.assertAlmostEqual(relmse, 0.01 / (0.09 + 0.01), places=12)


class Page(made.Folder):
    def setUp(self):
        super().setUp()
        data, pixels = made.cloud(), numpy.random.default_rng(2).random((20, 30, 3))
        data["command"] = 'vkvol bench "<a & b>.xml"'
        data["reference"]["file"], data["estimators"][0]["image"] = "reference.exr", "image.exr"
        data["estimators"][1]["image"] = "lost.exr"
        for name in ("reference.exr", "image.exr"):
            (Path(self.folder.name) / name).write_bytes(exr_of(pixels, 3))
        out = Path(self.folder.name) / "report.html"
        subprocess.run([sys.executable, ROOT / "tools" / "report", made.write(self.folder.name, "cumulus.bench.json", data),
                        "--peer", made.write(self.folder.name, "cumulus.peer.json", made.peer()),
                        "--scaling", made.write(self.folder.name, "s.json", made.scaling()), "-o", out], check=True)
        self.text = out.read_text()
        self.page = xml.fromstring(self.text)

    def test_it_needs_nothing_from_elsewhere(self):
        self.assertNotRegex(self.text, r"https?:|//[a-z]+\.|<script|<link|@import|url\(")
        for node in self.page.iter():
            for attribute in ("src", "href"):
                self.assertRegex(node.get(attribute, "#"), r"^(#|data:image/png;base64,)")

    def test_it_can_be_read_without_seeing(self):
        self.assertEqual(len(list(self.page.iter("h1"))), 1)
        self.assertTrue(all(image.get("alt") for image in self.page.iter("img")))
        self.assertEqual(len(list(self.page.iter("img"))), 2)
        for drawing in self.page.iter("svg"):
            self.assertTrue(drawing.get("aria-label") if drawing.get("role") == "img" else drawing.get("aria-hidden"))
        for header in self.page.iter("th"):
            self.assertIn(header.get("scope"), ("row", "col"))
        identities = [node.get("id") for node in self.page.iter() if node.get("id")]
        self.assertEqual(len(identities), len(set(identities)))

    def test_it_says_what_it_shows(self):
        text = " ".join(" ".join(self.page.itertext()).split())
        for part in ('vkvol bench "<a & b>.xml"', "lost.exr", "mitsuba 3.9.1", "same picture", "AMD EPYC", "2026-01-01", "near-linear",
                     "llvmpipe Mesa 22.3.6", "takes the density of one point"):
            self.assertIn(part, text)
        self.assertNotRegex(self.text, r"\b(nan|inf|None)\b(?!;)")


class Colours(unittest.TestCase):
    # Machado, Oliveira and Fernandes 2009, severity 1, for linear RGB.
    DEFICIENT = {"none": numpy.eye(3),
                 "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
                 "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
                 "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]]}

    @staticmethod
    def linear(colour):
        x = numpy.array([int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)])
        return numpy.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)

    def contrast(self, a, b):
        dark, light = sorted(float(self.linear(c) @ (0.2126, 0.7152, 0.0722)) for c in (a, b))
        return (light + 0.05) / (dark + 0.05)

    @staticmethod
    def lab(linear):
        to_xyz = numpy.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
        x = to_xyz @ numpy.clip(linear, 0, 1) / (0.9505, 1, 1.089)
        f = numpy.where(x > 0.008856, numpy.cbrt(x), 7.787 * x + 16 / 116)
        return numpy.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])

    def test_all_eyes_can_tell_them_apart(self):
        """15 in CIELAB is several times what can just be told apart; graphics need a contrast of 3 (WCAG 2.1, 1.4.11)."""
        style = (ROOT / "tools/report_page/style.css").read_text()
        pages = re.findall(r"--page: (#\w+)", style)
        for colours, page in ((palette.LIGHT, pages[0]), (palette.DARK, pages[1]), (palette.PASSES_LIGHT, pages[0]),
                              (palette.PASSES_DARK, pages[1])):
            for i, a in enumerate(colours):
                self.assertGreaterEqual(self.contrast(a, page), 3, a)
                for b in colours[:i]:
                    for name, matrix in self.DEFICIENT.items():
                        seen = [self.lab(numpy.array(matrix) @ self.linear(colour)) for colour in (a, b)]
                        apart = numpy.linalg.norm(seen[0] - seen[1])
                        self.assertGreater(apart, 15, (name, a, b))

    def test_text_has_contrast(self):
        """4.5 (WCAG 2.1, 1.4.3), on the page and on panels."""
        style = (ROOT / "tools/report_page/style.css").read_text()
        for scheme in range(2):
            colour = {name: found[scheme] for name in ("page", "panel", "ink", "soft", "use", "note", "caution", "link")
                      for found in [re.findall(rf"--{name}: (#\w+)", style)]}
            for name in ("ink", "soft", "use", "note", "caution", "link"):
                self.assertGreaterEqual(self.contrast(colour[name], colour["page"]), 4.5, name)
                self.assertGreaterEqual(self.contrast(colour[name], colour["panel"]), 4.5, name)

    def test_estimators_of_a_page_differ(self):
        chosen = palette.Palette(palette.KNOWN[:8])
        self.assertEqual(len({chosen.colour(n) for n in palette.KNOWN[:8]}), 8)
        chosen = palette.Palette(palette.KNOWN)
        self.assertEqual(len({(chosen.colour(n), chosen.shape(n)) for n in palette.KNOWN}), len(palette.KNOWN))


if __name__ == "__main__":
    unittest.main()
