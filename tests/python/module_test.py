"""The Python module: scenes, grids, pictures, and what goes wrong."""

import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
import weakref

import numpy as np

BUILD = pathlib.Path(os.environ["VKVOL_BUILD"])
if "VKVOL_INSTALLED" not in os.environ:  # else that of `pip install .`
    sys.path.insert(0, str(BUILD / "python"))
import vkvol  # noqa: E402

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"


def ball(size=24):
    """A soft ball, (x, y, z) apart from each other so that axes cannot be mistaken."""
    x, y, z = np.meshgrid(*[np.linspace(-1, 1, size + 2 * i) for i in range(3)], indexing="ij")
    return np.clip(1.2 - np.sqrt((1.0 * x) ** 2 + (1.3 * y) ** 2 + (1.7 * z - 0.3) ** 2), 0, 1).astype(np.float32)


def smoke(grids, **more):
    return {"densityField": grids, "sigma_a": {"unit": "world", "text": 0.5}, "sigma_s": {"unit": "world", "text": 4},
            "light": {"x": 1, "y": 2, "z": 1, "r": 1, "g": 0.9, "b": 0.8, "multiplier": 3},
            "backgroundColor": {"r": 0.1, "g": 0.2, "b": 0.4}, "camera": {"x": 0, "y": 0, "z": 5, "fov": 40},
            "width": 24, "height": 18, "rayPerPixelCount": 8, **more}


def placed(size=24):
    return vkvol.Grids(density=ball(size), voxel_size=2 / size, origin=(-1, -1.08, -1.16))


class Rendering(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_arrays_render_as_their_file_does(self):
        grids = vkvol.Grids(ball(), voxel_size=2 / 24, origin=(-1, -1.08, -1.16), temperature=1000 * ball())
        grids.write(self.path / "smoke.nvdb")
        emission = {"emission": {"r": 1e-3, "g": 5e-4, "b": 1e-4}}
        a = vkvol.render(vkvol.Scene.from_dict(smoke(grids, **emission)), seed=3)
        b = vkvol.render(vkvol.Scene.from_dict(smoke("smoke.nvdb", **emission), folder=self.path), seed=3)
        c = vkvol.render(vkvol.Scene.from_xml(vkvol.Scene.from_dict(smoke("it.nvdb", **emission)).xml,
                                              grids={"it.nvdb": grids}), seed=3)
        np.testing.assert_array_equal(a.mean, b.mean)
        np.testing.assert_array_equal(a.mean, c.mean)
        np.testing.assert_array_equal(a.variance, b.variance)
        self.assertEqual(a.mean.shape, (18, 24, 3))
        self.assertTrue(a.mean.std() > 0.01)

    def test_the_program_renders_the_same_bits(self):
        placed().write(self.path / "smoke.nvdb")
        scene = vkvol.Scene.from_dict(smoke("smoke.nvdb"), folder=self.path)
        (self.path / "scene.xml").write_text(scene.xml)
        picture = vkvol.render(scene, seed=5, spp=12, aov=["direct", "depth"])
        picture.write(self.path / "a.exr")
        subprocess.run([BUILD / "vkvol", self.path / "scene.xml", "--seed", "5", "--spp", "12", "--aov", "direct,depth", "-q",
                        "-o", self.path / "b.exr"], check=True)
        told = subprocess.run([BUILD / "vkvol", "compare", self.path / "a.exr", self.path / "b.exr", "--json"],
                              capture_output=True, text=True)
        self.assertEqual(json.loads(told.stdout)["relMSE"], 0)
        self.assertLessEqual({"direct", "depth"}, set(picture.layers))
        self.assertEqual(picture.layers["direct"].shape, (18, 24, 3))
        self.assertEqual(picture.layers["depth"].shape, (18, 24))

    def test_axes_of_arrays(self):
        # One dense voxel off the middle: to the right, above, and toward the camera, which is at +z and looks along -z.
        density = np.zeros((9, 9, 9), np.float32)
        density[7, 6, 4] = 1
        scene = smoke(vkvol.Grids(density=density, voxel_size=0.2, origin=(-0.8, -0.8, -0.8)),
                      sigma_a={"unit": "world", "text": 500}, sigma_s={"unit": "world", "text": 0}, light={"x": 1, "y": 1})
        picture = vkvol.render(vkvol.Scene.from_dict(scene), spp=64, width=64, height=64)
        dark = np.argwhere(picture.mean[..., 2] < 0.2)
        row, column = dark.mean(axis=0)
        pixels = 64 / (2 * 5 * np.tan(np.radians(20)))  # per world unit at the middle
        self.assertAlmostEqual(column, 31.5 + 0.6 * pixels, delta=1.5)
        self.assertAlmostEqual(row, 31.5 - 0.4 * pixels, delta=1.5)

    def test_colours(self):
        colors = np.ones((4, 4, 4, 3), np.float32) * np.array([1.0, 0.5, 0.0], np.float32)
        grids = vkvol.Grids(density=np.ones((4, 4, 4)), albedo=colors, voxel_size=0.5, origin=(-0.75, -0.75, -0.75))
        picture = vkvol.render(vkvol.Scene.from_dict(smoke(grids, albedo={"grid": "albedo"}, sigma_a={"unit": "world", "text": 0})),
                               spp=64, crop=(10, 14, 7, 11))
        red, green, blue = picture.mean.mean(axis=(0, 1)) / np.array([0.3 + 0.1, 0.27 + 0.2, 0.24 + 0.4])
        self.assertTrue(red > green > blue)

    def test_what_a_density_file_cannot_have_is_refused(self):
        placed().write(self.path / "a.nvdb")
        with self.assertRaisesRegex(vkvol.InputError, "grid replaces the density field of a scene"):
            vkvol.render(self.path / "a.nvdb", grid=self.path / "a.nvdb", spp=1)
        (self.path / "s.xml").write_text("<options><sphere/></options>")
        with self.assertRaisesRegex(vkvol.InputError, "up: is for density files"):
            vkvol.render(vkvol.Scene.from_file(self.path / "s.xml", up="z"), spp=1)

    def test_samples_as_wanted(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))
        session = vkvol.Session(scene, seed=7)
        with self.assertRaises(vkvol.RenderError):
            session.picture()
        self.assertEqual(session.render(3), 3)
        few = session.picture()
        self.assertEqual(session.render(16), 16)
        self.assertEqual(session.samples, 16)
        np.testing.assert_array_equal(session.picture().mean, vkvol.render(scene, seed=7, spp=16).mean)
        self.assertTrue((few.samples == 3).all())
        self.assertLess(session.picture().noise, few.noise)
        parts = [vkvol.render(scene, seed=7, spp=8, sample_offset=offset).mean for offset in (0, 8)]
        np.testing.assert_allclose(np.mean(parts, axis=0), session.picture().mean, rtol=1e-5)

    def test_until_the_noise_is_low(self):
        picture = vkvol.render(vkvol.Scene.from_dict(smoke(placed())), noise=0.1)
        self.assertLessEqual(picture.noise, 0.1)
        samples = int(picture.samples.max())
        self.assertEqual(samples & (samples - 1), 0)
        self.assertEqual(picture.report["samplesPerPixel"], {"least": samples, "most": samples})

    def test_files_alone(self):
        placed().write(self.path / "smoke.nvdb")
        session = vkvol.Session(self.path / "smoke.nvdb", width=16, spp=2)
        session.render()
        self.assertIn("smoke.nvdb", session.assumed)
        self.assertEqual(session.picture().mean.shape[1:], (16, 3))
        pbrt = vkvol.render(SCENES / "pbrt" / "fog_ball.pbrt", width=16, spp=2)
        self.assertEqual(pbrt.mean.shape[1], 16)
        keyed = vkvol.Scene.from_xml('<options><sphere/><sigma_a>$a</sigma_a><camera z="4"/></options>', defines={"a": 2})
        self.assertTrue((vkvol.render(keyed, width=8, height=8).mean == 0).all())

    def test_looks(self):
        picture = vkvol.render(vkvol.Scene.from_dict(smoke(placed())))
        image = picture.develop()
        self.assertEqual((image.shape, image.dtype), ((18, 24, 3), np.uint8))
        self.assertGreater(picture.develop(exposure=1).mean(), image.mean())
        self.assertEqual(picture._repr_png_()[:4], b"\x89PNG")
        picture.write(self.path / "a.png", tonemap="agx", exposure="auto")
        picture.write(self.path / "a.csv")
        self.assertIn("24x18, 8 samples, noise", repr(picture))
        with self.assertRaisesRegex(vkvol.InputError, "none of srgb"):
            picture.develop("filmic")


class Scenes(unittest.TestCase):
    def test_dicts_are_scene_files(self):
        xml = vkvol.Scene.from_dict({
            "width": 8, "volumes": [("volume", {"name": "haze", "everywhere": {}, "sigma_a": 0.5}),
                                    ("volume", {"like": "haze", "transform": [("scale", {"value": 2.0}), ("translate", {"y": 1})]})],
            "lights": [("point", {"x": 1, "r": np.float32(0.5)})], "models": [("model", "a.obj")],
            "surfaces": [("mesh", {"vertices": np.eye(3), "triangles": np.array([[0, 1, 2]]), "normals": "flat"}),
                         ("disk", {"lookAt": (0, 1, 0)})]}).xml
        self.assertEqual(xml, '<options><width>8</width><volumes><volume name="haze"><everywhere /><sigma_a>0.5</sigma_a></volume>'
                              '<volume like="haze"><transform><scale value="2.0" /><translate y="1" /></transform></volume></volumes>'
                              '<lights><point x="1" r="0.5" /></lights><models><model>a.obj</model></models>'
                              '<surfaces><mesh normals="flat"><vertices>1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0</vertices>'
                              '<triangles>0 1 2</triangles></mesh><disk lookAt="0 1 0" /></surfaces></options>')

    def test_errors_name_place_and_remedy(self):
        def refused(wrong, error=vkvol.InputError, **options):
            with self.assertRaisesRegex(error, wrong):
                vkvol.render(vkvol.Scene.from_xml("<options><sphere/><camera z='4'/></options>"), width=4, height=4, **options)

        for options, wrong in (({"spp": 0}, "spp: 0 is not a whole number from 1"), ({"spp": 1.5}, "spp: 1.5"),
                               ({"aov": ["depht"]}, "aov: 'depht' is none of"), ({"crop": (0, 9, 0, 1)}, "crop"),
                               ({"crop": (0, 1)}, "crop"), ({"integrator": "ratioTraking"}, "ratioTracking"),
                               ({"schedule": "both"}, "none of auto, fused, staged"), ({"noise": 1}, "noise: 1 is not between"),
                               ({"time": -1}, "time"), ({"time": "5m"}, "time: '5m' is no number"),
                               ({"crop": 5}, "crop: 5 is not"), ({"aov": None}, "aov: None is no list"), ({"seed": -1}, "seed"), ({"grid": "none.nvdb"}, "none.nvdb")):
            with self.subTest(options=options):
                refused(wrong, **options)
        refused("no usable device", vkvol.DeviceError, device="nobody's")
        with self.assertRaisesRegex(vkvol.InputError, r"scene.xml:1:10: .*sphere"):
            vkvol.render(vkvol.Scene.from_xml("<options><shpere/></options>"))
        with self.assertRaisesRegex(vkvol.InputError, "none.xml"):
            vkvol.render("none.xml")
        with self.assertRaisesRegex(vkvol.InputError, r"shape \(nx, ny, nz\)"):
            vkvol.Grids(density=np.zeros((3, 3)))
        with self.assertRaisesRegex(vkvol.InputError, "voxel_size"):
            vkvol.Grids(density=np.zeros((3, 3, 3)), voxel_size=0)
        for wrong in ({"origin": (0, 0)}, {"voxel_size": (1, 2)}, {"voxel_size": "x"}):
            with self.subTest(grids=wrong), self.assertRaisesRegex(vkvol.InputError, f"{next(iter(wrong))}: .* is not three numbers"):
                vkvol.Grids(density=np.zeros((3, 3, 3)), **wrong)
        self.assertTrue(issubclass(vkvol.InputError, (ValueError,)) and issubclass(vkvol.InputError, vkvol.Error))
        self.assertTrue(issubclass(vkvol.RenderError, RuntimeError) and issubclass(vkvol.DeviceError, vkvol.Error))

    def test_what_is_not_honoured_is_a_warning(self):
        scene = vkvol.Scene.from_xml("<options><sphere/><camera z='4'/><light x='1' r='1'/></options>")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            vkvol.Session(scene, width=4, height=4, integrator="ratioTracking:mis=power")
        self.assertEqual([w.category for w in caught], [vkvol.SceneWarning])
        self.assertIn("mis is without effect", str(caught[0].message))

    def test_what_is_less_than_it_claims_is_a_warning(self):
        density = ball()
        density[3, 4, 5] = -1
        density[4, 4, 5] = np.nan
        session = vkvol.Session(vkvol.Scene.from_dict(smoke(vkvol.Grids(density=density))))
        session.render(2)
        with self.assertWarnsRegex(vkvol.SceneWarning, "^2 voxels were NaN, infinite or negative and count as 0"):
            picture = session.picture()
        self.assertEqual(len(picture.notes), 1)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            session.picture()  # said once

    def test_one_grid_of_many_volumes_is_uploaded_once(self):
        once, other = placed(), placed()
        shared = [("volume", {"densityField": grids, "sigma_s": 1, "transform": [("translate", {"x": 3.0 * i})]})
                  for i, grids in enumerate((once, once, other, once))]
        scene = vkvol.Scene.from_dict({"volumes": shared, "camera": {"z": 9}, "width": 8, "height": 6, "backgroundColor": {"r": 1}})
        picture = vkvol.render(scene, spp=1)
        self.assertEqual(picture.report["media"]["distinctGrids"], 2)

    def test_warnings_are_of_the_line_that_asked(self):
        scene = vkvol.Scene.from_xml("<options><sphere/><camera z='4'/><light x='1' r='1'/></options>")
        options = {"width": 4, "height": 4, "spp": 1, "integrator": "ratioTracking:mis=power"}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("default")  # once a line
            vkvol.render(scene, **options)
            vkvol.render(scene, **options)
            vkvol.Session(scene, **options)
        self.assertEqual([w.filename for w in caught], 3 * [__file__])
        self.assertEqual(len({w.lineno for w in caught}), 3)


class Running(unittest.TestCase):
    def test_progress_and_what_it_raises(self):
        scene, seen = vkvol.Scene.from_dict(smoke(placed())), []
        session = vkvol.Session(scene, spp=64, progress=lambda samples, noise: seen.append((samples, noise)))
        session.render()
        self.assertEqual(seen[-1][0], 64)
        self.assertEqual(sorted(seen), seen)

        def stop(samples, noise):
            raise KeyError("enough")

        stopped = vkvol.Session(scene, spp=64, progress=stop)
        with self.assertRaisesRegex(KeyError, "enough"):
            stopped.render()

    def test_what_a_render_calls_cannot_render(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))
        other = vkvol.Session(scene)
        for work in (other.render, other.picture, lambda: vkvol.Session(scene)):
            with self.assertRaisesRegex(vkvol.RenderError, "rendering on this thread"):
                vkvol.Session(scene, progress=lambda samples, noise, work=work: work()).render()

        class Old:  # a cycle, found by the collector amid a render
            pass

        old = Old()
        old.me, old.session = old, vkvol.Session(scene)
        gone = weakref.ref(old)
        del old
        vkvol.Session(scene, progress=lambda samples, noise: gc.collect()).render()
        self.assertIsNone(gone())
        other.render()

    def test_sessions_go_when_nobody_has_them(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))

        class Owner:
            def __init__(self):
                self.session = vkvol.Session(scene, progress=self.progress)

            def progress(self, samples, noise):
                raise KeyError("enough")

        owner = Owner()
        with self.assertRaises(KeyError):
            owner.session.render()
        gone = weakref.ref(owner.session)
        del owner
        gc.collect()
        self.assertIsNone(gone())

    def test_letting_go_of_a_session_waits_for_nobody(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))
        begun, gone, sessions = threading.Event(), threading.Event(), [vkvol.Session(scene)]
        sessions[0].render(1)

        def let_go():
            begun.wait()
            sessions.clear()
            gone.set()

        def progress(samples, noise):
            begun.set()
            self.assertTrue(gone.wait(20))

        thread = threading.Thread(target=let_go)
        thread.start()
        vkvol.Session(scene, spp=64, progress=progress).render()
        thread.join()

    def test_black_is_good_enough(self):
        scene = vkvol.Scene.from_xml("<options><sphere/><camera z='4'/></options>")
        self.assertEqual(int(vkvol.render(scene, width=4, height=4, noise=0.01).samples.max()), 1 << 18)

    def test_interrupted_and_gone_on_with(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))
        session = vkvol.Session(scene, width=96, seed=9)
        session.render(1)  # its kernels are there
        before = signal.signal(signal.SIGINT, signal.default_int_handler)  # which shells' background jobs ignore
        self.addCleanup(signal.signal, signal.SIGINT, before)
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), 2))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            session.render(2**30)
        timer.join()
        done = session.samples
        self.assertGreater(done, 1)
        self.assertGreaterEqual(int(session.picture().samples.min()), done)
        whole = session.render(done + 20)
        np.testing.assert_array_equal(session.picture().mean, vkvol.render(scene, width=96, seed=9, spp=whole).mean)

    def test_ctrl_c_is_for_the_main_thread(self):
        session = vkvol.Session(vkvol.Scene.from_dict(smoke(placed())), width=96)
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        ends = []
        thread = threading.Timer(0.3, lambda: ends.append(session.render(1)))  # which waits for the session
        thread.start()
        timer = threading.Timer(0.8, lambda: os.kill(os.getpid(), 2))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            session.render(2**30)
        thread.join()
        self.assertEqual(len(ends), 1)

    def test_threads_take_turns_and_python_runs_on(self):
        scene = vkvol.Scene.from_dict(smoke(placed()))
        expected = [vkvol.render(scene, seed=seed).mean for seed in range(4)]
        pictures = [None] * 4

        def work(i):
            pictures[i] = vkvol.render(scene, seed=i).mean

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for a, b in zip(expected, pictures):
            np.testing.assert_array_equal(a, b)

        ticks = 0
        long = threading.Thread(target=lambda: vkvol.render(scene, time=1.0))
        long.start()
        while long.is_alive():
            ticks += 1
            time.sleep(0.01)
        self.assertGreater(ticks, 30)  # of some 100; without its turn this thread has one or two

    def test_every_device_is_listed(self):
        self.assertTrue(any(device["usable"] for device in vkvol.devices()))
        self.assertIn("ratioTracking", vkvol.integrators())

    def test_ends_in_peace(self):
        code = ("import sys; sys.path[:] = sys.argv[1:]; import vkvol; "
                "s = vkvol.Session(vkvol.Scene.from_xml('<options><sphere/><camera z=\"4\"/></options>'), width=8, height=8); "
                "s.render(1); print(s.picture())")
        done = subprocess.run([sys.executable, "-c", code, *sys.path], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("8x8, 1 sample>", done.stdout)

    def test_a_daemon_that_renders_ends_in_peace(self):
        code = ("import sys; sys.path[:] = sys.argv[1:]; import threading, time, vkvol; "
                "s = vkvol.Session(vkvol.Scene.from_xml('<options><sphere/><camera z=\"4\"/></options>'), width=8, height=8, "
                "progress=lambda samples, noise: None); "
                "threading.Thread(target=s.render, args=(2**30,), daemon=True).start(); time.sleep(0.3)")
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", code, *sys.path], capture_output=True, text=True, timeout=120)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_forked_process_writes_no_exr(self):
        code = ("import sys; sys.path[:] = sys.argv[1:]; import os, tempfile, vkvol\n"
                "scene = vkvol.Scene.from_xml('<options><sphere/><camera z=\"4\"/></options>')\n"
                "picture = vkvol.render(scene, width=64, height=64, spp=1)\n"
                "with tempfile.TemporaryDirectory() as folder:\n"
                "    picture.write(folder + '/a.exr')  # from here on its library has threads\n"
                "    if not os.fork():\n"
                "        picture.write(folder + '/b.png')\n"
                "        try:\n"
                "            picture.write(folder + '/b.exr')\n"
                "        except vkvol.RenderError as error:\n"
                "            print(error, flush=True)\n"
                "        os._exit(7)\n"
                "    print(os.waitstatus_to_exitcode(os.wait()[1]), sorted(os.listdir(folder)))")
        done = subprocess.run([sys.executable, "-W", "ignore::DeprecationWarning", "-c", code, *sys.path], capture_output=True,
                              text=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("was forked from one that has used a device", done.stdout)
        self.assertTrue(done.stdout.endswith("7 ['a.exr', 'b.png']\n"), done.stdout)

    def test_a_forked_process_is_told(self):
        code = ("import sys; sys.path[:] = sys.argv[1:]; import os, vkvol\n"
                "scene = vkvol.Scene.from_xml('<options><sphere/><camera z=\"4\"/></options>')\n"
                "session = vkvol.Session(scene, width=8, height=8)\n"
                "session.render(1)\n"
                "if not os.fork():\n"
                "    for work in (session.render, lambda: vkvol.Session(scene)):\n"
                "        try:\n"
                "            work()\n"
                "        except vkvol.RenderError as error:\n"
                "            print(error, flush=True)\n"
                "    os._exit(7)  # as multiprocessing does: drivers wait at exit for threads of the parent's\n"
                "print(os.waitstatus_to_exitcode(os.wait()[1]), session.render(2))")
        # From 3.12 on Python warns of forks where there are threads.
        done = subprocess.run([sys.executable, "-W", "ignore::DeprecationWarning", "-c", code, *sys.path], capture_output=True,
                              text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.count("was forked from one that has used a device"), 2)
        self.assertTrue(done.stdout.endswith("7 2\n"))


if __name__ == "__main__":
    unittest.main()
