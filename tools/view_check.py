"""Drives the page of `vkvol view` in a real browser: every control, keyboard, pointers, two themes, a phone's width, many
tabs and the scene's file changed meanwhile. Writes pictures of the page to look at.

    python3 tools/view_check.py [--vkvol build/vkvol] [--browser /usr/bin/chromium] [-o FOLDER]

Needs PyPI's playwright (its Python part alone) and a Chromium, Debian's for instance. Ends with 1 if something did not
come out as it should.
"""

import argparse
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

SCENE = """<options>
  <sphere radius="2"/>
  <sigma_s unit="world">1.5</sigma_s>
  <sigma_a unit="world">0.1</sigma_a>
  <width>{width}</width>
  <height>240</height>
  <camera x="0" y="1" z="9" pitch="-6" fov="40"/>
  <light x="1" y="1" z="0.5" r="1" g="0.9" b="0.8" multiplier="3"/>
  <backgroundColor r="0.2" g="0.3" b="0.5"/>
</options>
"""


class Checks:
    """Claims that are printed as they are made, and whether all held."""

    def __init__(self):
        self.good = True

    def __call__(self, claim, holds):
        print(f"{'ok  ' if holds else 'FAIL'} {claim}", flush=True)
        self.good = self.good and bool(holds)


def until(test, seconds=20.0):
    """Whether the test becomes true in that time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if test():
            return True
        time.sleep(0.1)
    return False


def state(page, name):
    """A field of the last state that the page got, or None."""
    return page.evaluate("name => state && name in state ? state[name] : null", name)


def slide(page, selector, value):
    page.eval_on_selector(
        selector,
        "(input, value) => { input.value = value; input.dispatchEvent(new Event('input', { bubbles: true })); }",
        str(value),
    )


def is_settled(page):
    """Whether what is shown is what was asked for last."""
    return page.evaluate("() => state && !sending && !unsent && state.wish >= mine && state.sceneWish === state.wish")


def camera(page):
    until(lambda: is_settled(page))
    return tuple(round(x, 6) for x in state(page, "camera")["position"])


def is_shown(page):
    """Whether the canvas has light that is not the same everywhere."""
    return page.evaluate(
        """() => { const c = document.getElementById('picture');
            const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            let low = 255, high = 0;
            for (let i = 0; i < d.length; i += 4) { low = Math.min(low, d[i]); high = Math.max(high, d[i]); }
            return high - low > 20; }"""
    )


def check_picture(page, check):
    for layer in ("noise", "direct", "indirect", "emission", "background", "depth", "position", "albedo", "transmittance", "normal"):
        page.select_option("#layer", layer)
        check(f"layer {layer}", until(lambda: state(page, "layer") == layer and state(page, "width") > 0))
    page.select_option("#layer", "picture")
    check("layer picture again", until(lambda: state(page, "layer") == "picture" and is_shown(page)))
    slide(page, "#exposure", 1.5)
    check("exposure by the slider", until(lambda: state(page, "exposure") == 1.5))
    page.click("#auto")
    check("exposure chosen", until(lambda: state(page, "exposure") not in (0, 1.5)))
    for curve in ("agx", "aces", "reinhard", "srgb"):
        page.select_option("#curve", curve)
        check(f"curve {curve}", until(lambda: state(page, "curve") == curve))
    page.click("#asScene")
    check("exposure and curve of the scene", until(lambda: state(page, "exposure") == 0 and state(page, "curve") == "srgb"))


def check_view(page, check):
    home = camera(page)
    page.focus("#picture")
    for key in ("ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Shift+ArrowLeft", "Shift+ArrowUp", "+", "-"):
        before = camera(page)
        page.keyboard.press(key)
        check(f"key {key} on the picture", until(lambda: camera(page) != before, 5))
    box = page.locator("#picture").bounding_box()
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)

    def drag(claim, button, modifier=None):
        before = camera(page)
        if modifier:
            page.keyboard.down(modifier)
        page.mouse.move(*middle)
        page.mouse.down(button=button)
        page.mouse.move(middle[0] + 60, middle[1] + 20, steps=6)
        page.mouse.up(button=button)
        if modifier:
            page.keyboard.up(modifier)
        check(claim, until(lambda: camera(page) != before, 5))

    drag("dragging turns", "left")
    distance = sum((a - b) ** 2 for a, b in zip(camera(page), state(page, "target")))
    drag("dragging turns about the medium", "left")
    again = sum((a - b) ** 2 for a, b in zip(camera(page), state(page, "target")))
    check(f"at the same distance ({distance:.4g}, {again:.4g})", abs(distance - again) < 1e-3 * distance)
    drag("dragging with shift moves", "left", "Shift")
    drag("dragging with the right button moves", "right")
    before = camera(page)
    page.mouse.move(*middle)
    page.mouse.wheel(0, 300)
    check("the wheel goes away", until(lambda: camera(page) != before))
    slide(page, "#fov", 60)
    check("angle of view", until(lambda: state(page, "camera")["fov"] == 60))
    page.click("#resetView")
    check("the scene's view again", until(lambda: camera(page) == home and state(page, "camera")["fov"] == 40))


def check_scene(page, check):
    slide(page, "#density", 2)
    check("density", until(lambda: state(page, "density") == 4 and state(page, "wish") == state(page, "sceneWish")))
    slide(page, "#density", 0)
    slide(page, "#light0", 1)
    check("brightness of a light", until(lambda: state(page, "lights")[0]["factor"] == 2))
    old = state(page, "lights")[0]["direction"]
    slide(page, "#azimuth0", -90)
    check("azimuth of a light", until(lambda: state(page, "lights")[0]["direction"][0] < -0.5))
    slide(page, "#elevation0", 80)
    check("elevation of a light", until(lambda: state(page, "lights")[0]["direction"][1] > 0.98))
    check("which it had not before", old[1] < 0.9)
    slide(page, "#light1", -1)
    check("brightness of the background", until(lambda: state(page, "lights")[1]["factor"] == 0.5))
    page.select_option("#integrator", "deltaTrackingNEE")
    check("an integrator", until(lambda: state(page, "integrator") == "deltaTrackingNEE" and not state(page, "sketch")))
    check("is told to be unbiased", until(lambda: "unbiased" in page.inner_text("#estimates")))
    page.select_option("#integrator", "homogeneousRayMarcherNEE")
    check("a biased one is told to be", until(lambda: ", biased" in page.inner_text("#estimates")))
    page.evaluate("() => { wish.integrator = 'nonsense'; send(); }")
    check("what is none is told to be", until(lambda: "nonsense" in page.inner_text("#message")))
    page.select_option("#integrator", "deltaTracking")
    page.select_option("#integrator", "")
    check("the scene's again", until(lambda: state(page, "wishedIntegrator") == "" and page.inner_text("#message") == ""))


def check_time(page, check):
    page.click("#pause")
    check("pause", until(lambda: state(page, "paused")))
    time.sleep(1.0)
    samples = state(page, "samples")
    time.sleep(1.0)
    check("no more samples then", state(page, "samples") == samples)
    page.click("#pause")
    check("and on", until(lambda: not state(page, "paused") and (state(page, "samples") > samples or state(page, "done"))))
    check("noise over time is drawn", until(lambda: len(page.get_attribute("#chart path", "d") or "") > 10))


def check_keys(page, check):
    page.click("h1")
    page.keyboard.press("n")
    check("key n", until(lambda: state(page, "layer") == "noise"))
    page.keyboard.press("n")
    check("key n again", until(lambda: state(page, "layer") == "picture"))
    page.keyboard.press("]")
    check("key ]", until(lambda: state(page, "exposure") == 0.5))
    page.keyboard.press("[")
    check("key [", until(lambda: state(page, "exposure") == 0))
    page.keyboard.press("p")
    check("key p", until(lambda: state(page, "paused")))
    page.keyboard.press("p")
    check("key p again", until(lambda: not state(page, "paused")))
    page.focus("#picture")
    home = camera(page)
    page.keyboard.press("ArrowLeft")
    until(lambda: camera(page) != home)
    page.keyboard.press("r")
    check("key r", until(lambda: camera(page) == home))


def check_keeping(page, check, folder):
    for button, magic in (("#saveExr", b"\x76\x2f\x31\x01"), ("#savePng", b"\x89PNG"), ("#saveScene", b"<?xml")):
        with page.expect_download() as download:
            page.click(button)
        file = folder / download.value.suggested_filename
        download.value.save_as(file)
        content = file.read_bytes()
        check(f"{file.name} is kept", content.lstrip().startswith(magic) or (button == "#saveScene" and b"<options>" in content))


def check_file(page, check, scene):
    width = 300
    scene.write_text(SCENE.format(width=width))
    check("another size in the file", until(lambda: state(page, "width") == width))
    scene.write_text("<options><sphere/>")
    check("a broken file is told", until(lambda: "scene.xml:1" in page.inner_text("#message")))
    check("and the picture stays", state(page, "width") == width)
    scene.write_text(SCENE.format(width=400))
    check("a mended one is rendered", until(lambda: page.inner_text("#message") == "" and state(page, "width") == 400))


def answer(address):
    try:
        return urllib.request.urlopen(address, timeout=10).status
    except urllib.error.HTTPError as error:
        return error.code


def check_tabs(context, page, check, address, process):
    before = state(page, "samples")
    tabs = [context.new_page() for _ in range(10)]
    for tab in tabs:
        tab.goto(address)
    check("ten tabs show it", all(until(lambda: is_shown(tab)) for tab in tabs))
    try:
        tabs[0].goto("chrome://crash", timeout=3000)
    except Exception:  # the answer dies with the page
        pass
    for tab in tabs[1:]:
        tab.close()
    check("a tab that dies and nine that close do no harm", process.poll() is None and answer(address) == 200)
    check("it was rendered meanwhile", until(lambda: state(page, "samples") > before or state(page, "done")))


def drive(playwright, arguments, folder, check):
    scene = folder / "scene.xml"
    scene.write_text(SCENE.format(width=400))
    process = subprocess.Popen([arguments.vkvol, "view", scene, "-q"], stdout=subprocess.PIPE, text=True)
    address = process.stdout.readline().strip()
    browser = playwright.chromium.launch(executable_path=arguments.browser, args=["--no-sandbox"])
    try:
        context = browser.new_context(viewport={"width": 1200, "height": 800}, accept_downloads=True)
        page = context.new_page()
        troubles, hosts = [], set()
        # But for a word about this file's own reading of the canvas.
        page.on("console", lambda message: message.type in ("error", "warning") and "400" not in message.text
                and "willReadFrequently" not in message.text and troubles.append(message.text))
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.on("request", lambda request: hosts.add(request.url.split("/")[2]))
        page.goto(address)
        check("the page has a picture", until(lambda: is_shown(page) and not state(page, "sketch")))
        page.screenshot(path=arguments.output / "light.png")
        check_picture(page, check)
        check_view(page, check)
        check_scene(page, check)
        page.screenshot(path=arguments.output / "changed.png")
        check_time(page, check)
        check_keys(page, check)
        check_keeping(page, check, folder)
        check_file(page, check, scene)
        check(f"no word of trouble in the console {troubles[:3]}", not troubles)
        check(f"nothing but this machine is asked {hosts}", hosts == {address.split("/")[2]})
        for name, options in (("dark", {"color_scheme": "dark", "viewport": {"width": 1200, "height": 800}}),
                              ("phone", {"viewport": {"width": 390, "height": 844}, "has_touch": True})):
            other = browser.new_context(**options).new_page()
            other.goto(address)
            until(lambda: is_shown(other))
            time.sleep(1.0)
            other.screenshot(path=arguments.output / f"{name}.png", full_page=name == "phone")
            check(f"{name}: nothing wider than the page",
                  other.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth"))
        check_tabs(context, page, check, address, process)
        root = address.split("?")[0]
        check("a wrong key gets 403", answer(root + "?key=0") == 403 and answer(root + "frame?since=0&key=") == 403)
    finally:
        browser.close()
        process.send_signal(signal.SIGINT)
        check("Ctrl-C ends it with 0", process.wait(timeout=20) == 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vkvol", default="build/vkvol", type=pathlib.Path)
    parser.add_argument("--browser", default=shutil.which("chromium") or "chromium")
    parser.add_argument("-o", "--output", default="build/view_check", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        sys.exit("view_check.py: needs playwright; e.g. python3 -m venv V && V/bin/pip install playwright")
    arguments.output.mkdir(parents=True, exist_ok=True)
    check = Checks()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        drive(playwright, arguments, pathlib.Path(folder), check)
    sys.exit(0 if check.good else 1)


if __name__ == "__main__":
    main()
