#!/usr/bin/env python3
"""Renders a vkvol scene with vkvol and with Mitsuba 3, and says how fast each removes error and whether they agree.

Needs the Python package `mitsuba`:

    python3 -m venv peers && peers/bin/pip install mitsuba numpy
    peers/bin/python tools/peers/mitsuba.py scenes/bench/cloud.xml --time 60s -o cloud

Variants llvm_* need LLVM, version 17 or newer (Debian: libllvm19). If it is not found, or an older one is, name it:
DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1. What is equal and what is not: tools/peers/README.md."""
import argparse
import os
import pathlib
import sys
import tempfile
import time

try:
    import numpy as np
except ModuleNotFoundError:
    raise SystemExit("mitsuba: numpy is missing: pip install numpy, best in an environment of its own")

import contest
import grid as grids
import lights
import mitsuba_lights
import mitsuba_surfaces
import scene as scenes
import vkvol

# This file is called what it needs, and Python looks in a script's own folder first.
sys.path.remove(str(pathlib.Path(__file__).resolve().parent))

NEVER = 1 << 30  # a depth that no path reaches
LARGEST_PASS = 1 << 24  # paths in flight; each takes some 100 bytes


def phase(function):
    if function.name == "rayleigh":
        return {"type": "rayleigh"}
    first = {"type": "hg", "g": function.g}
    if function.name == "henyeyGreenstein":
        return first
    return {"type": "blendphase", "weight": function.share, "first": first, "second": {"type": "hg", "g": function.second}}


class Description:
    """The scene in Mitsuba's terms, a dictionary for load_dict."""

    def __init__(self, scene, mi, options):
        self.scene, self.mi, self.options = scene, mi, options
        # Mitsuba has one map or constant background.
        self.maps = [light for light in scene.lights if isinstance(light, lights.Sky)]
        for light in self.maps:
            light.texels = light.texels + scene.background

    def dictionary(self, integrator):
        scene = self.scene
        result = {"type": "scene", "integrator": self.integrator(integrator), "sensor": self.sensor()}
        if scene.medium is not None:
            result["boundary"] = self.boundary()
        for i, surface in enumerate(scene.surfaces):
            result[f"surface{i}"] = mitsuba_surfaces.entry(self.mi, surface)
        if scene.background.any() and not self.maps:
            result["sky"] = {"type": "constant", "radiance": mitsuba_lights.rgb(scene.background)}
            if self.options.sky == "escape" and self.has_lights():
                result["sky"]["sampling_weight"] = 0.0  # of shadow rays
        corners = scene.corners()
        translate = mitsuba_lights.Lights(self.mi, corners.mean(axis=0), np.linalg.norm(np.ptp(corners, axis=0)), self.fail)
        result.update((f"light{i}", translate.entry(light)) for i, light in enumerate(scene.lights))
        return result

    def has_lights(self):
        """Besides the sky: what shadow rays are to look for, as ours do."""
        return bool(self.scene.lights) or any(np.any(surface.emission) for surface in self.scene.surfaces)

    def fail(self, what):
        sys.exit(f"{self.scene.path}: {what}")

    def integrator(self, name):
        # Mitsuba counts path segments up to the light, vkvol the collisions between them.
        depth = -1 if self.scene.max_depth is None else self.scene.max_depth + 1
        return {"type": name, "max_depth": depth, "rr_depth": self.options.roulette_depth}

    def sensor(self):
        camera, picture = self.scene.camera, self.scene.picture
        whole = [*picture.start, *picture.reference]
        if any(v != int(v) for v in whole):
            sys.exit("the picture starts or its reference frame ends within a pixel, which Mitsuba cannot render; take "
                     "a --width and --height that divide the frame evenly")
        distance = np.linalg.norm(self.scene.corners() - camera.position, axis=1).max()
        farthest = 1e3 * distance + 2 * mitsuba_lights.FAR * distance  # beyond the sun
        sensor = {
            "type": "perspective", "fov": camera.fov, "fov_axis": "y",
            "to_world": self.mi.ScalarTransform4f().look_at(
                camera.position.tolist(), (camera.position + camera.forward).tolist(), camera.up.tolist()),
            # Rays begin at the near plane: within the rounding of what they meet.
            "near_clip": float(1e-6 * distance), "far_clip": float(farthest),
            "sampler": {"type": "independent"},
            "film": {"type": "hdrfilm", "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"},
                     "width": int(picture.reference[0]), "height": int(picture.reference[1]),
                     "crop_offset_x": int(picture.start[0]), "crop_offset_y": int(picture.start[1]),
                     "crop_width": picture.width, "crop_height": picture.height}}
        if self.scene.medium is not None and self.scene.medium.shape.contains(camera.position):
            sensor["medium"] = {"type": "ref", "id": "medium"}
        return sensor

    def boundary(self):
        shape = self.scene.medium.shape
        if isinstance(shape, scenes.Sphere):
            result = {"type": "sphere", "center": shape.center.tolist(), "radius": shape.radius}
        elif isinstance(shape, scenes.Box):
            low, high = shape.center - shape.size / 2, shape.center + shape.size / 2
            result = {"type": "cube", "to_world": self.box_transform(np.eye(4), low, high, -1)}
        else:
            result = {"type": "cube", "to_world": self.box_transform(shape.matrix, *shape.support(), -1)}
        medium = dict(self.medium(), id="medium")
        return dict(result, bsdf={"type": "null"}, interior=medium)

    def box_transform(self, matrix, low, high, begin):
        """From the cube [begin, 1]^3 to the box [low, high] before `matrix`."""
        scale = (high - low) / (1 - begin)
        box = np.eye(4)
        box[:3, :3], box[:3, 3] = np.diag(scale), low - begin * scale
        if begin == -1 and np.linalg.det(matrix) < 0:
            box[:3, 0] *= -1  # the same box, and its normals point outwards again
        return self.mi.ScalarTransform4f((matrix @ box).tolist())

    def medium(self):
        medium = self.scene.medium
        grey = np.ptp(medium.sigma_t) == 0
        strength = float(medium.sigma_t.max())
        albedo = np.divide(medium.sigma_s, medium.sigma_t, out=np.zeros(3), where=medium.sigma_t > 0)
        result = {"type": "homogeneous", "albedo": float(albedo[0]) if np.ptp(albedo) == 0 else mitsuba_lights.rgb(albedo),
                  "scale": strength, "sigma_t": 1.0 if grey else mitsuba_lights.rgb(medium.sigma_t / strength),
                  "has_spectral_extinction": not grey, "phase": phase(medium.phase),
                  "sample_emitters": self.options.sky == "sampled" or self.has_lights()}
        if isinstance(medium.shape, grids.Grid):
            result.update(type="heterogeneous", sigma_t=self.field(None if grey else medium.sigma_t / strength))
        return result

    def field(self, colour):
        """Mitsuba has its values at the centres of cells, [z, y, x, channel]."""
        shape = self.scene.medium.shape
        values = np.ascontiguousarray(shape.values.transpose(2, 1, 0)[..., None])
        if colour is not None:
            values = values * colour.astype(np.float32)
        return {"type": "gridvolume", "grid": self.mi.VolumeGrid(values), "raw": True,
                "filter_type": "nearest" if self.scene.medium.nearest else "trilinear",
                "to_world": self.box_transform(shape.matrix, *shape.cell_box(), 0)}


class Mitsuba:
    def __init__(self, options, integrator):
        import drjit
        import mitsuba
        self.mi, self.dr = mitsuba, drjit
        self.options, self.integrator = options, integrator
        self.jit = not options.variant.startswith("scalar")
        self.load_seconds = self.kernel_seconds = None
        start = time.monotonic()
        self.scene = scenes.read(options.scene, options.width, options.height, options.keys, options.grid)
        self.pixels = self.scene.picture.width * self.scene.picture.height
        self.read_seconds = time.monotonic() - start

    def name(self):
        return f"mitsuba {self.mi.__version__} {self.options.variant} {self.integrator}"

    def warm_up(self):
        start = time.monotonic()
        description = Description(self.scene, self.mi, self.options)
        self.mi_scene = self.mi.load_dict(description.dictionary(self.integrator))
        for light in description.maps:
            if not mitsuba_lights.map_agrees(self.mi, self.mi_scene.environment(), light):
                description.fail(f"<sky>: Mitsuba {self.mi.__version__} has texels in other places; take 3.9.1")
        self.load_seconds = self.read_seconds + time.monotonic() - start
        if self.jit:
            self.dr.set_flag(self.dr.JitFlag.KernelHistory, True)
        self.render(1, 0)
        if self.jit:
            # Milliseconds; unlike the first render's time, they do not depend on how long its paths are.
            self.kernel_seconds = sum(kernel.get("codegen_time", 0) + kernel.get("backend_time", 0)
                                      for kernel in self.dr.kernel_history()) / 1e3
            self.dr.set_flag(self.dr.JitFlag.KernelHistory, False)

    def render(self, samples, seed):
        most = max(1, LARGEST_PASS // self.pixels)
        start, busy, done, image = time.monotonic(), time.process_time(), 0, 0.0
        while done < samples:
            count = min(most, samples - done)
            # Seeds of passes are far from those of other renders.
            part = self.mi.render(self.mi_scene, spp=count, seed=seed + 100003 * (done // most))
            image = image + count / samples * np.array(part, dtype=float)
            done += count
        if self.jit:
            self.dr.sync_thread()
        seconds = time.monotonic() - start
        return image, seconds, (time.process_time() - busy) / seconds

    def set_up(self):
        return {"load": self.load_seconds, "upload": None, "pipeline": None, "coldPipeline": self.kernel_seconds}

    def details(self):
        return {"isDefault": False}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    vkvol.add_options(parser)
    contest.add_options(parser)
    parser.add_argument("--variant", default="llvm_ad_rgb", choices=("llvm_ad_rgb", "scalar_rgb", "cuda_ad_rgb"),
                        help="of Mitsuba (default llvm_ad_rgb)")
    parser.add_argument("--peer-integrators", default="volpath", help="Mitsuba's, with commas: volpath, volpathmis")
    parser.add_argument("--sky", default="escape", choices=("escape", "sampled"),
                        help="escape: only paths that leave the medium see the sky, and all shadow rays go to the sun; "
                             "sampled: Mitsuba's default, which chooses one of the two for each shadow ray")
    parser.add_argument("--roulette-depth", type=int, default=NEVER, help="scattering events before Mitsuba plays Russian "
                                                                          "roulette (default: never)")
    options = parser.parse_args()
    # Dr.Jit keeps compiled kernels in the home folder; without it, the first render shows what compiling takes.
    with tempfile.TemporaryDirectory() as folder:
        os.environ["HOME"] = folder
        try:
            import mitsuba
            mitsuba.set_variant(options.variant)
        except ImportError as error:  # also of a variant that lacks its LLVM or CUDA
            sys.exit(f"{error}\nmitsuba {options.variant} cannot be used; --help says how to install what is missing")
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        import drjit
        drjit.set_thread_count(options.threads)
        peers = [Mitsuba(options, integrator) for integrator in options.peer_integrators.split(",")]
        trial = contest.Contest(options, [vkvol.Vkvol(options, folder), *peers])
        trial.run()
        return trial.finish()


if __name__ == "__main__":
    sys.exit(main())
