"""Times vkvol and the scalar reference on the demo cloud, in alternation, and prints medians. See benchmark.sh."""
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

root, runs = sys.argv[1], int(sys.argv[2])
vkvol, reference = f"{root}/build/vkvol", f"{root}/build/reference_render"
scene = f"{root}/scenes/cumulus.xml"

# The cloud filled with sky alone, isotropic and without absorption, is the case that other renderers are quoted for.
sky_only = f"""<options>
  <densityField baseDir="{root}/density_fields/">cumulus.nvdb</densityField>
  <sigma_a>0</sigma_a> <sigma_s>0.3</sigma_s> <integrator>deltaTracking</integrator>
  <width reference="480">480</width> <height reference="270">270</height>
  <camera x="-14" y="5" z="88" pitch="8.5" yaw="-9" fov="28"/> <backgroundColor r="1" g="1" b="1"/>
</options>"""
background = """<options>
  <width reference="480">480</width> <height reference="270">270</height> <backgroundColor r="1" g="1" b="1"/>
</options>"""


def render(path, spp, directory):
    report = f"{directory}/report.json"
    subprocess.run([vkvol, path, "--spp", str(spp), "-o", f"{directory}/a.exr", "--report", report, "-q"], check=True)
    with open(report) as file:
        return json.load(file)


def render_reference(path, spp, directory):
    """Paths per second, as reference_render prints them."""
    out = subprocess.run([reference, path, "--spp", str(spp), "--threads", str(os.cpu_count()), "-o",
                          f"{directory}/r.exr"], check=True, capture_output=True, text=True)
    return float(re.search(r"([0-9.e+]+) paths/s", out.stdout + out.stderr).group(1))


def median(values):
    return statistics.median(values)


def describe(name, reports):
    samples = median([r["perSecond"]["samples"] for r in reports])
    collisions = median([r["perSecond"]["tentativeCollisions"] for r in reports])
    print(f"{name}: {samples / 1e3:.0f} thousand samples/s, {collisions / 1e6:.2f} million tentative collisions/s")
    counts, paths = reports[0]["counts"], reports[0]["counts"]["paths"]
    print("  per path: " + ", ".join(f"{counts[k] / paths:.2f} {k}" for k in
                                     ("realCollisions", "nullCollisions", "majorantCells", "shadowRays")))
    passes = {p: median([r["seconds"]["passes"][p] for r in reports]) for p in reports[0]["seconds"]["passes"]}
    print("  seconds by pass: " + ", ".join(f"{p} {s:.3f}" for p, s in passes.items()))
    print("  seconds by phase: " + ", ".join(
        f"{k} {median([r['seconds'][k] for r in reports]):.3f}" for k in ("load", "upload", "pipeline", "render", "write")))
    return samples


with tempfile.TemporaryDirectory() as directory:
    paths = {"sky": f"{directory}/sky.xml", "background": f"{directory}/background.xml"}
    for name, text in (("sky", sky_only), ("background", background)):
        with open(paths[name], "w") as file:
            file.write(text)
    lit, sky, empty, scalar_lit, scalar_sky = [], [], [], [], []
    for _ in range(runs):
        lit.append(render(scene, 16, directory))
        scalar_lit.append(render_reference(scene, 4, directory))
        sky.append(render(paths["sky"], 16, directory))
        scalar_sky.append(render_reference(paths["sky"], 4, directory))
        empty.append(render(paths["background"], 256, directory))
    print(f"Device: {lit[0]['device']['name']}, {lit[0]['device']['driver']}; {os.cpu_count()} processors; load "
          f"{os.getloadavg()[0]:.1f}; medians of {runs}")
    for name, reports, scalar in (("cumulus, sun and sky", lit, scalar_lit), ("cumulus, sky only", sky, scalar_sky)):
        samples = describe(name, reports)
        print(f"  scalar reference: {median(scalar) / 1e3:.0f} thousand samples/s; ratio {samples / median(scalar):.2f}")
    describe("background only", empty)
