#!/usr/bin/env python3
"""Writes a vkvol scene for pbrt-v4, and adds finished pbrt renders to a table that mitsuba.py has made.

    python3 tools/peers/pbrt_scene.py scenes/bench/cloud.xml --width 128 --samples 64 -o cloud.pbrt
    pbrt cloud.pbrt --outfile cloud-pbrt.exr
    python3 tools/peers/pbrt_scene.py scenes/bench/cloud.xml --result cloud-pbrt.exr --samples 64 --seconds 93 \\
        --table cloud.peer.json

Needs NumPy. Several results, made with pbrt's --seed, give the efficiency an interval. What is equal and what is
not: tools/peers/README.md."""
import argparse
import json
import math
import pathlib
import statistics
import sys

try:
    import numpy as np
except ModuleNotFoundError:
    raise SystemExit("pbrt_scene: numpy is missing: pip install numpy, best in an environment of its own")

import contest
import exr
import grid as grids
import lights
import scene as scenes
import vkvol

UNLIMITED = 1 << 30  # scattering events
LARGE = 100_000_000  # voxels in a file of text
SIGNIFICANCE = 0.001
# Triangles of a box whose corner i has bit k of i set where coordinate k is high; counter-clockwise from outside.
FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def numbers(values):
    return " ".join(f"{float(v):.9g}" for v in values)


def camera_lines(scene, options):
    camera, picture = scene.camera, scene.picture
    whole = [*picture.start, *picture.reference]
    if any(v != int(v) for v in whole):
        sys.exit("the picture starts or its reference frame ends within a pixel, which pbrt cannot render; take a "
                 "--width and --height that divide the frame evenly")
    x, y, width, height = (int(v) for v in whole)
    # pbrt's angle spans the shorter edge, vkvol's the height.
    fov = camera.fov
    if width < height:
        fov = math.degrees(2 * math.atan(math.tan(math.radians(fov) / 2) * width / height))
    target = camera.position + camera.forward
    yield "Scale -1 1 1  # right-handed"
    yield f"LookAt {numbers(camera.position)}  {numbers(target)}  {numbers(camera.up)}"
    if scene.medium.shape.contains(camera.position):
        yield 'MediumInterface "" "medium"'
    yield f'Camera "perspective" "float fov" [ {fov:.9g} ]'
    yield (f'Film "rgb" "string filename" [ "{options.output.stem}.exr" ] "integer xresolution" [ {width} ] '
           f'"integer yresolution" [ {height} ] "integer pixelbounds" [ {x} {x + picture.width} {y} {y + picture.height} ] '
           '"bool savefp16" [ false ]')
    yield 'PixelFilter "box" "float xradius" [ 0.5 ] "float yradius" [ 0.5 ]'
    yield f'Sampler "independent" "integer pixelsamples" [ {options.samples} ]'
    depth = UNLIMITED if scene.max_depth is None else scene.max_depth
    yield f'Integrator "volpath" "integer maxdepth" [ {depth} ]'


def medium_lines(medium):
    """Coefficients are per world unit, whatever the medium's transform."""
    for name, sigma in (("sigma_a", medium.sigma_a), ("sigma_s", medium.sigma_s)):
        if np.ptp(sigma) == 0:  # as it is, at every wavelength
            yield f'  "spectrum {name}" [ 200 {sigma[0]:.9g} 900 {sigma[0]:.9g} ]'
        else:
            yield f'  "rgb {name}" [ {numbers(sigma)} ]'
    yield f'  "float g" [ {medium.phase.g:.9g} ]'


def grid_lines(grid):
    """Values at the centres of cells, x fastest, in the grid's index space."""
    low, high = grid.cell_box()
    yield f'  "point3 p0" [ {numbers(low)} ] "point3 p1" [ {numbers(high)} ]'
    nx, ny, nz = grid.values.shape
    yield f'  "integer nx" [ {nx} ] "integer ny" [ {ny} ] "integer nz" [ {nz} ]'
    yield '  "float density" ['
    for row in grid.values.transpose(2, 1, 0).reshape(-1, nx):
        yield " ".join(f"{v:.9g}" for v in row.tolist()) if row.any() else "0 " * nx
    yield "  ]"


def boundary_lines(shape):
    if isinstance(shape, scenes.Sphere):
        yield f"Translate {numbers(shape.center)}"
        yield f'Shape "sphere" "float radius" [ {shape.radius:.9g} ]'
        return
    corners = shape.corners()
    inside_out = isinstance(shape, grids.Grid) and np.linalg.det(shape.matrix[:3, :3]) < 0
    indices = []
    for a, b, c, d in FACES:
        indices += [a, c, b, a, d, c] if inside_out else [a, b, c, a, c, d]
    yield (f'Shape "trianglemesh" "point3 P" [ {numbers(corners.ravel())} ] '
           f'"integer indices" [ {" ".join(map(str, indices))} ]')


def light_lines(scene):
    if scene.background.any():
        yield f'LightSource "infinite" "rgb L" [ {numbers(scene.background)} ]'
    for light in scene.lights:
        if not isinstance(light, lights.Directional):
            sys.exit(f"{scene.path}: <{type(light).__name__.lower()}> is not translated for pbrt; take a <directional> light")
        yield (f'LightSource "distant" "rgb L" [ {numbers(light.irradiance)} ] "point3 from" [ {numbers(light.direction)} ] '
               '"point3 to" [ 0 0 0 ]')


def scene_lines(scene, options):
    if scene.surfaces:
        sys.exit(f"{scene.path}: surfaces are not translated for pbrt; remove <surfaces>")
    medium, shape = scene.medium, scene.medium.shape
    is_grid = isinstance(shape, grids.Grid)
    if is_grid and medium.nearest:
        sys.exit(f"{scene.path}: pbrt always interpolates; remove <filter>nearest</filter>")
    if is_grid and shape.values.size > LARGE:
        sys.exit(f"{shape.path}: has {shape.values.size} voxels, too many for a text file; crop the grid")
    if medium.phase.name != "henyeyGreenstein":
        sys.exit(f"{scene.path}: <phase> {medium.phase.name} is not translated for pbrt; take henyeyGreenstein")
    yield f"# {scene.path.name}, made by pbrt_scene.py"
    yield from camera_lines(scene, options)
    # Between Camera and WorldBegin: pbrt places media relative to the camera, and a camera inside wants its medium by then.
    yield "Identity"
    if is_grid:
        yield f"Transform [ {numbers(shape.matrix.T.ravel())} ]"
    yield f'MakeNamedMedium "medium" "string type" [ "{"uniformgrid" if is_grid else "homogeneous"}" ]'
    yield from medium_lines(medium)
    if is_grid:
        yield from grid_lines(shape)
    yield "WorldBegin"
    yield from light_lines(scene)
    yield "AttributeBegin"
    yield 'MediumInterface "medium" ""'
    yield 'Material "interface"'
    yield from boundary_lines(shape)
    yield "AttributeEnd"


def efficiency_of(errors, seconds):
    logs = [-math.log(error * seconds) for error in errors]
    if len(logs) > 1:
        return contest.interval(logs)
    return {"value": math.exp(logs[0]), "low": None, "high": None}


def ratio_of(a, b):
    """Of two independent figures, whose relative errors add in squares."""
    ratio = a["value"] / b["value"]
    if a["low"] is None:
        return {"value": ratio, "low": None, "high": None}
    half = math.hypot(*(math.log(figure["high"] / figure["low"]) / 2 for figure in (a, b)))
    return {"value": ratio, "low": ratio * math.exp(-half), "high": ratio * math.exp(half)}


def result_entry(options, table):
    reference, variance, _ = exr.read_rgb(table["reference"]["file"])
    images = [exr.read_rgb(path)[0] for path in options.result]
    for path, image in zip(options.result, images):
        if image.shape != reference.shape:
            sys.exit(f"{path}: is {image.shape[1]}x{image.shape[0]} pixels, the reference {reference.shape[1]}x"
                     f"{reference.shape[0]}; render it at the size of the table")
    errors = [contest.relative_mse(image, reference, variance) for image in images]
    if min(errors) <= 0:
        sys.exit("the result's error is below the reference's noise; make the table again with more --time")
    agreement = contest.mean_agreement(np.mean(images, axis=0), reference)
    # Each of three channels may be off by chance (Sidak).
    bound = statistics.NormalDist().inv_cdf(1 - (1 - (1 - SIGNIFICANCE) ** (1 / 3)) / 2)
    same = bool(max(map(abs, agreement["z"])) <= bound)
    agreement.update(same=same, reason=f"of the picture means alone, bound {bound:.2f}", image=str(options.result[0]))
    efficiency, pixels = efficiency_of(errors, options.seconds), reference.shape[0] * reference.shape[1]
    spread = statistics.stdev(errors) / math.sqrt(len(errors)) if len(errors) > 1 else None
    point = {"samples": options.samples, "runs": len(errors), "seconds": options.seconds, "secondsLow": None,
             "secondsHigh": None, "relMse": statistics.fmean(errors), "relMseError": spread, "relMseFromVariance": None}
    return {"renderer": options.title, "isDefault": False, "biased": "",
            "setupSeconds": {"load": None, "upload": None, "pipeline": None, "coldPipeline": None}, "points": [point],
            "slope": None, "biasFloor": None, "efficiency": efficiency,
            "perPath": None, "laneUse": {}, "passSeconds": None, "samplesPerSecond": options.samples * pixels / options.seconds,
            "busyCores": None, "image": str(options.result[0]), "agreement": agreement}


def add_result(options):
    try:
        table = json.loads(options.table.read_text())
    except (OSError, ValueError) as error:
        sys.exit(f"{options.table}: cannot be read: {error}; make it with tools/peers/mitsuba.py")
    entry = result_entry(options, table)
    table["estimators"].append(entry)
    table["ranking"].append({"renderer": entry["renderer"],
                             "efficiencyRatioToDefault": ratio_of(entry["efficiency"], table["estimators"][0]["efficiency"])})
    options.table.write_text(json.dumps(table, indent=2) + "\n")
    contest.print_table(table)
    return 0 if entry["agreement"]["same"] else 4


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    vkvol.add_scene_options(parser)
    parser.add_argument("-o", dest="output", type=pathlib.Path, help="the .pbrt file (default: the scene's name)")
    parser.add_argument("--samples", type=int, default=64, help="per pixel (default 64)")
    parser.add_argument("--result", type=pathlib.Path, nargs="+", metavar="OUT.exr", help="finished renders, one for each seed")
    parser.add_argument("--seconds", type=float, help="that one of them took, rendering alone")
    parser.add_argument("--table", type=pathlib.Path, metavar="NAME.peer.json", help="where the results are added")
    parser.add_argument("--title", default="pbrt-v4 volpath", help="of the results in the table")
    options = parser.parse_args()
    if options.result:
        if not options.seconds or not options.table:
            parser.error("--result needs --seconds and --table")
        return add_result(options)
    options.output = options.output or pathlib.Path(options.scene.stem + ".pbrt")
    scene = scenes.read(options.scene, options.width, options.height, options.keys, options.grid)
    if scene.medium is not None and (np.ptp(scene.medium.sigma_t) or np.ptp(scene.medium.sigma_s)):
        print("note: pbrt renders spectra; coefficients that differ between r, g and b are smooth curves there, and the "
              "picture will differ", file=sys.stderr)
    text = "".join(line + "\n" for line in scene_lines(scene, options))  # all of it, or nothing
    options.output.write_text(text)
    print(f"written: {options.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
