"""tools/peers: lights and maps of the sky as vkvol means them, and as another renderer is told. Needs no such renderer."""

import pathlib
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/peers"))
import blackbody  # noqa: E402
import exr  # noqa: E402
import lights  # noqa: E402
import make_sky  # noqa: E402
import mitsuba_lights  # noqa: E402
import scene  # noqa: E402
import sky  # noqa: E402

RIGHT, LEFT, AHEAD, UP = (np.array(v, float) for v in ((1, 0, 0), (-1, 0, 0), (0, 0, -1), (0, 1, 0)))


def read(elements, keys=()):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.xml"
        camera = "" if any(f"<{name}" in elements for name in ("camera", "irradiance", "fluence")) else "<camera/>"
        path.write_text(f"<options><sphere/>{camera}{elements}</options>")
        return scene.read(path, keys=keys)


def lights_of(elements):
    return read(f"<lights>{elements}</lights>").lights


def some_directions(count):
    found = np.random.default_rng(3).normal(size=(count, 3))
    return found / np.linalg.norm(found, axis=1)[:, None]


class SkyTest(unittest.TestCase):
    def test_the_middle_is_ahead_and_further_right_is_to_the_right(self):
        texels = np.zeros((3, 8, 3))
        texels[1, 3:5] = 1  # about the middle
        texels[1, 5:7] = 2  # about a quarter further right
        texels[0] = 3
        for direction, value in ((AHEAD, 1), (RIGHT, 2), (LEFT, 0), (UP, 3)):
            np.testing.assert_allclose(sky.radiance(texels, direction), value, atol=1e-12)

    def test_a_map_turns_counter_clockwise_as_seen_from_above(self):
        texels = np.zeros((3, 8, 3))
        texels[1, 3:5] = 1
        np.testing.assert_allclose(sky.radiance(texels, LEFT, 90), 1)
        np.testing.assert_allclose(sky.radiance(texels, RIGHT, -90), 1)

    def test_directions_find_their_texels(self):
        texels = np.random.default_rng(1).random((5, 6, 3))
        towards = sky.directions(*np.mgrid[:5, :6], 5, 6)
        np.testing.assert_allclose(sky.radiance(texels, towards), texels, atol=1e-12)

    def test_rows_at_the_poles_change_nothing(self):
        texels = np.random.default_rng(2).random((5, 6, 3))
        rows = sky.with_rows_at_poles(texels)
        for direction in some_directions(200):
            # As Mitsuba looks it up: the first and the last row lie at the poles, the last is never the lower of two.
            column = (np.arctan2(direction[0], -direction[2]) / (2 * np.pi) + 0.5) * 6 - 0.5
            row = np.arccos(direction[1]) / np.pi * (len(rows) - 1)
            left, top = int(np.floor(column)), min(int(row), len(rows) - 2)
            f, g = column - left, row - top
            across = rows[:, left % 6] * (1 - f) + rows[:, (left + 1) % 6] * f
            np.testing.assert_allclose(across[top] * (1 - g) + across[top + 1] * g, sky.radiance(texels, direction), atol=1e-6)

    def test_the_map_that_is_kept_is_the_one_that_is_made_with_its_sun_where_it_is_said(self):
        texels = sky.read(make_sky.OUTPUT)
        np.testing.assert_allclose(texels, make_sky.texels(), rtol=2e-3)  # half floats have 11 bits
        found = sky.directions(*np.unravel_index(texels.sum(axis=2).argmax(), texels.shape[:2]), *texels.shape[:2])
        texel = np.pi / make_sky.HEIGHT
        self.assertLess(np.arccos(found @ lights.unit(make_sky.SUN)), texel)


class LightsTest(unittest.TestCase):
    def test_power_is_what_a_light_sends_out_in_all(self):
        point, sphere, disk, rectangle = lights_of(
            '<point power="8"/><sphere radius="2" power="8"/><disk lookAt="0 0 1" radius="2" power="8"/>'
            '<rectangle lookAt="0 0 1" width="2" height="3" power="8"/>')
        self.assertAlmostEqual(4 * np.pi * point.intensity[0], 8)
        self.assertAlmostEqual(np.pi * 4 * np.pi * 2**2 * sphere.radiance[0], 8)  # pi times radiance leaves each area
        self.assertAlmostEqual(np.pi * np.pi * 2**2 * disk.radiance[0], 8)
        self.assertAlmostEqual(np.pi * 2 * 3 * rectangle.radiance[0], 8)

    def test_power_of_a_spot_is_that_of_its_smooth_step(self):
        spot, = lights_of('<spot lookAt="0 0 1" angle="60" blend="0.5" power="8"/>')
        cosine = np.linspace(-1, 1, 200001)
        none, full = np.cos(np.radians(30)), np.cos(np.radians(15))
        t = np.clip((cosine - none) / (full - none), 0, 1)
        power = 2 * np.pi * np.mean(t * t * (3 - 2 * t)) * 2 * spot.intensity[0]
        self.assertAlmostEqual(power, 8, places=3)

    def test_colours(self):
        white, grey, red, warm = lights_of('<point/><point multiplier="0.5"/><point r="2" multiplier="3"/><point kelvin="3000"/>')
        for light, colour in ((white, (1, 1, 1)), (grey, (0.5, 0.5, 0.5)), (red, (6, 0, 0)), (warm, blackbody.rgb(3000))):
            np.testing.assert_allclose(light.intensity, colour)

    def test_a_black_body_has_luminance_1_and_reddens_as_it_cools(self):
        for kelvin in (3000, 6500, 20000):
            self.assertAlmostEqual(blackbody.rgb(kelvin) @ [0.2126, 0.7152, 0.0722], 1, places=3)
        np.testing.assert_allclose(blackbody.rgb(6504), 1, rtol=0.1)  # Rec.709's white, but for daylight's own shade
        self.assertGreater(blackbody.rgb(2500)[0], 2 * blackbody.rgb(2500)[1])

    def test_black_lights_are_left_out(self):
        self.assertEqual(lights_of('<point r="0"/><daylight multiplier="0"/><spot multiplier="0"/>'), [])

    def test_the_old_light_is_a_directional_one(self):
        light, = read('<light x="0" y="3" z="0" r="1" g="2" multiplier="2"/>').lights
        np.testing.assert_allclose((light.direction, light.irradiance), ((0, 1, 0), (2, 4, 0)))

    def test_without_looks_only_what_paths_meet_is_seen(self):
        elements = '<lights><point/><sun y="1"/></lights>'
        found = read("<integrator>deltaTracking</integrator>" + elements).lights
        self.assertEqual([type(light) for light in found], [lights.Sun])
        self.assertEqual(len(read(elements).lights), 2)

    def test_what_cannot_be_translated_is_named(self):
        for elements, words in (("<lights><daylight y='1'/></lights>", "<daylight> is not translated"),
                                ("<phase>draine</phase>", "<phase> draine is not translated"),
                                ("<lights><spot/></lights>", "<spot> lookAt"),
                                ("<lights><sky>sky.hdr</sky></lights>", "from .exr files only"),
                                ("<camera lookAt='0 0 0' distance='3'/>", "orbits are not translated"),
                                ("<lights><point x='${= 1+1}'/></lights>", "computes"),
                                ("<camera projection='orthographic'/>", "projection orthographic is not translated"),
                                ("<camera projection='${p:-equirectangular}'/>", "projection equirectangular is not"),
                                ("<camera viewHeight='3'/>", "viewHeight"),
                                ("<fluence>0 0 0</fluence>", "<fluence> reads flux"),
                                ("<camera lensRadius='0.5' focus='3'/>", "lenses are not translated"),
                                ("<pixelFilter>tent</pixelFilter>", "<pixelFilter> is not translated"),
                                ("<pixelFilter radius='1'>box</pixelFilter>", "<pixelFilter> is not translated"),
                                ("<albedo grid='Cd'/>", "(<albedo>), which is not translated"),
                                ("<densityMap gain='2'/>", "(<densityMap>), which is not translated"),
                                ("<transferFunction/>", "(<transferFunction>), which is not translated")):
            with self.assertRaises(SystemExit) as stopped:
                read(elements)
            self.assertIn(words, str(stopped.exception))
            self.assertNotIn("\n", str(stopped.exception))


class SceneTest(unittest.TestCase):
    def test_keys_have_defaults(self):
        elements = '<lights><point x="${x:-2}" y="$y"/></lights>'
        self.assertEqual(read(elements, ["y=3"]).lights[0].position.tolist(), [2, 3, 0])
        self.assertEqual(read(elements, ["x=5", "y=3"]).lights[0].position.tolist(), [5, 3, 0])

    def test_what_is_as_it_is_without_a_word_of_it_is_read(self):
        plain = '<camera projection="perspective" lensRadius="0" fov="30"/><pixelFilter radius="0.5">box</pixelFilter>'
        self.assertEqual(read(plain).camera.fov, 30)

    def test_cameras_look_at_points(self):
        camera = read('<camera x="1" lookAt="1 0 -4"/>').camera
        np.testing.assert_allclose(camera.forward, AHEAD)
        np.testing.assert_allclose(camera.up, UP)


class SurfacesTest(unittest.TestCase):
    def surface(self, text):
        return read(f"<surfaces>{text}</surfaces>").surfaces[0]

    def test_transforms_count_one_after_another(self):
        box = self.surface('<box x="1"><transform><rotate y="1" angle="90"/><scale value="2"/><translate y="5"/></transform></box>')
        np.testing.assert_allclose(box.matrix @ [0, 0, 0, 1], [0, 5, -2, 1], atol=1e-12)
        np.testing.assert_allclose(box.matrix @ [0, 0, 1, 1], [1, 5, -2, 1], atol=1e-12)

    def test_flat_ones_face_where_they_look(self):
        for text, towards in (('<disk x="1" lookAt="1 -3 0"/>', -UP), ('<plane y="2"/>', UP),
                              ('<rectangle y="-1" lookAt="0 0 0" width="2" height="4"/>', UP)):
            matrix = self.surface(text).matrix
            np.testing.assert_allclose(matrix[:3, 2], towards, atol=1e-12)
        np.testing.assert_allclose(np.ptp(self.surface('<rectangle z="1" lookAt="0 0 9" width="2" height="4"/>').corners(),
                                          axis=0)[:2], [2, 4], atol=1e-12)

    def test_what_they_are_made_of(self):
        glowing = self.surface('<sphere r="0.2" g="0.4" b="0.6" multiplier="0.5"><emission r="3" g="2" b="1"/></sphere>')
        np.testing.assert_allclose(glowing.color, [0.1, 0.2, 0.3])
        np.testing.assert_allclose(glowing.emission, [3, 2, 1])
        metal = self.surface('<sphere material="conductor" eta="1 2 3" k="4"/>')
        np.testing.assert_allclose([metal.color, metal.eta, metal.k], [[1, 1, 1], [1, 2, 3], [4, 4, 4]])
        for text in ('<sphere material="conductor" metal="gold"/>', '<disk lookAt="0 1 0"><emission sides="2"/></disk>',
                     "<cone/>", "<box><transform><matrix/></transform></box>"):
            with self.assertRaises(SystemExit):
                self.surface(text)


class SpotPictureTest(unittest.TestCase):
    def test_interpolated_it_is_the_smooth_step_of_the_cosine(self):
        for angle, blend in ((40.0, 0.2), (100.0, 1.0)):
            spot = lights.Spot(None, None, None, angle, blend)
            picture = mitsuba_lights.spot_picture(spot)[:, :, 0]
            edge = np.radians(angle / 2)
            theta = np.linspace(0, edge, 500)
            none, full = np.cos(edge), np.cos(edge * (1 - blend))
            t = np.clip((np.cos(theta) - none) / (full - none), 0, 1)
            turn = np.linspace(0, 7, 500)
            x, y = (np.tan(theta) / np.tan(edge) * f(turn) for f in (np.cos, np.sin))
            place = [np.clip((v + 1) / 2 * len(picture) - 0.5, 0, len(picture) - 1.001) for v in (y, x)]
            (row, down), (column, across) = ((v.astype(int), v % 1) for v in place)
            found = ((picture[row, column] * (1 - across) + picture[row, column + 1] * across) * (1 - down)
                     + (picture[row + 1, column] * (1 - across) + picture[row + 1, column + 1] * across) * down)
            np.testing.assert_allclose(found, t * t * (3 - 2 * t), atol=5e-4)


class ExrTest(unittest.TestCase):
    def test_what_is_written_is_read(self):
        picture = {name: np.random.default_rng(4).random((37, 5)).astype("<f4") for name in "RGB"}
        with tempfile.TemporaryDirectory() as folder:
            for compress in (False, True):
                path = pathlib.Path(folder) / "picture.exr"
                exr.write_channels(path, picture, compress)
                for name, plane in exr.read(path).items():
                    np.testing.assert_array_equal(plane, picture[name])


if __name__ == "__main__":
    unittest.main()
