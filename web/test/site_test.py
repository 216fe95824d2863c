#!/usr/bin/env python3
"""The viewer without a server in a headless Chromium: opens files, clicks, and compares the maps with the program ahm.

Screenshots are left in --work. With --measure, prints times on a mesh of 41,186 vertices instead.
"""
import argparse
import csv
import functools
import gzip
import http.server
import io
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import threading
import time
import unittest
import zlib

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

options = None


class Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *arguments):
        pass


class Browser:
    """Chromium, and a server of a folder of static files."""

    def __init__(self, folder=None):
        self.work = pathlib.Path(options.work).resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=folder or options.site))
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.address = f"http://127.0.0.1:{self.server.server_port}/"
        chrome = webdriver.ChromeOptions()
        chrome.binary_location = shutil.which("chromium")
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
                         "--enable-unsafe-swiftshader", "--window-size=1366,768", "--no-first-run", f"--user-data-dir={self.work / 'profile'}"):
            chrome.add_argument(argument)
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=chrome)
        self.driver.set_script_timeout(300)

    def close(self):
        self.driver.quit()
        self.server.shutdown()
        self.server.server_close()
        shutil.rmtree(self.work / "profile", ignore_errors=True)

    def js(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, condition):
        WebDriverWait(self.driver, 120, 0.05).until(lambda driver: self.js("return " + condition))

    def open_sample(self, n):
        """Opens the sample with 2 n (n - 1) + 2 vertices, and enters its frame."""
        self.driver.get("about:blank")
        self.driver.get(f"{self.address}#sample={n}")
        self.enter_viewer()

    def open_file(self, path):
        self.driver.get("about:blank")
        self.driver.get(self.address)
        self.driver.find_element(By.ID, "pick").send_keys(str(path.resolve()))

    def drop(self, *paths):
        """Drops files on the middle of the page, as the file manager does."""
        data = {"items": [], "files": [str(path.resolve()) for path in paths], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.driver.execute_cdp_cmd("Input.dispatchDragEvent", {"type": kind, "x": 600, "y": 400, "data": data})

    def enter_viewer(self):
        self.wait("document.getElementById('viewer') !== null")
        self.driver.switch_to.frame("viewer")
        self.wait("window.ahm && ahm.stage && ahm.stage.map && !ahm.busy")

    def answer(self, name, request):
        """The answer of the session to a request, as text."""
        return self.driver.execute_async_script(
            "const done = arguments[2]; ahm.server.post(arguments[0], arguments[1]).then((a) => a.text()).then(done, (e) => done('error: ' + e.message))", name, request)


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def tearDown(self):
        errors = [entry for entry in self.browser.driver.get_log("browser")
                  if entry["level"] in ("SEVERE", "WARNING") and "swiftshader" not in entry["message"].lower() and "GPU stall" not in entry["message"]]
        self.assertEqual(errors, [])

    def expect_rows(self, text, expected):
        """Compares two .csv files: numbers agree to 1e-9 of the largest one of their column."""
        found, expected = (list(csv.reader(io.StringIO(t))) for t in (text, expected))
        self.assertEqual(found[0], expected[0])
        self.assertEqual(len(found), len(expected))
        for k, name in enumerate(expected[0]):
            if name == "status":
                self.assertEqual([row[k] for row in found], [row[k] for row in expected])
                continue
            largest = max((abs(float(row[k])) for row in expected[1:] if math.isfinite(float(row[k]))), default=1)
            for a, b in zip(found[1:], expected[1:]):
                if a[k] != b[k]:
                    self.assertAlmostEqual(float(a[k]), float(b[k]), delta=1e-9 * largest, msg=f"{name} of row {a[0]}")

    def expect_file_of_the_program(self, request, what, *command):
        saved = self.browser.answer("export", dict(request, what=what, format="csv"))
        file = self.browser.work / "program.csv"
        subprocess.run([options.ahm, *command, "-o", str(file)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.browser.work)
        self.expect_rows(saved, file.read_text())

    def store_sample(self):
        """Writes the file that the page opened."""
        text = self.browser.driver.execute_async_script("parent.ahm.files[0].text().then(arguments[0])")
        (self.browser.work / "bumps.off").write_text(text)

    def test_a_click_on_the_sample_draws_the_map_of_the_program(self):
        browser = self.browser
        browser.open_sample(40)
        self.assertEqual(browser.js("return document.getElementById('heading').textContent"), "bumps.off")
        before = browser.js("return document.getElementById('spec').textContent")
        width, height = browser.js("return [ahm.stage.width, ahm.stage.height]")
        canvas = browser.driver.find_element(By.ID, "canvas")
        ActionChains(browser.driver).move_to_element_with_offset(canvas, round(0.1 * width), round(-0.1 * height)).click().perform()
        browser.wait(f"document.getElementById('spec').textContent !== {before!r} && !ahm.busy && !ahm.stage.pending")
        source = browser.js("return document.getElementById('spec').textContent")
        self.assertTrue(source.startswith("face:"), source)
        self.assertEqual(browser.js("return document.getElementById('command').textContent"), f"ahm logmap bumps.off --source {source} -o map.csv --method polar")
        browser.driver.save_screenshot(str(browser.work / "sample.png"))
        request = browser.js("return ahm.request")
        shown = browser.js("return Array.from(ahm.stage.map.distance, (x) => x * ahm.stage.surface.scale)")
        saved = list(csv.DictReader(io.StringIO(browser.answer("export", dict(request, what="map", format="csv")))))
        for row, distance in zip(saved, shown):
            self.assertAlmostEqual(distance, float(row["distance"]), delta=1e-6)
        if not options.ahm:
            self.skipTest("there is no program to compare with")
        self.store_sample()
        logmap = ("logmap", "bumps.off", "--source", source)
        self.expect_file_of_the_program(request, "map", *logmap, "--method", "polar")
        self.expect_file_of_the_program(dict(request, method="exact"), "map", *logmap, "--method", "exact")
        self.expect_file_of_the_program(dict(request, method="heat"), "map", *logmap, "--method", "heat")
        self.expect_file_of_the_program({"from": {"row": 0}, "to": {"row": 500}}, "path", "path", "bumps.off", "--from", "0", "--to", "500")

    def test_files_are_opened_and_errors_are_shown(self):
        browser = self.browser
        cloud = browser.work / "cloud.xyz"
        golden = math.pi * (3 - math.sqrt(5))
        rows = []
        for k in range(2000):
            z = 1 - (2 * k + 1) / 2000
            rows.append(f"{math.sqrt(1 - z * z) * math.cos(golden * k)} {math.sqrt(1 - z * z) * math.sin(golden * k)} {z}\n")
        cloud.write_text("".join(rows))
        packed = browser.work / "packed.xyz.gz"
        packed.write_bytes(gzip.compress(cloud.read_bytes()))
        for file, title in ((cloud, "cloud.xyz"), (packed, "packed.xyz")):
            browser.open_file(file)
            browser.enter_viewer()
            self.assertEqual(browser.js("return document.getElementById('heading').textContent"), title)
            self.assertIn("2,000 points", browser.js("return document.getElementById('about').textContent"))
        browser.driver.save_screenshot(str(browser.work / "cloud.png"))
        plain = browser.work / "plain.xyz.gz"
        plain.write_bytes(cloud.read_bytes())
        browser.open_file(plain)
        browser.wait("document.getElementById('say').classList.contains('error')")
        self.assertEqual(browser.js("return document.getElementById('say').textContent"),
                         "cannot read 'plain.xyz.gz': it is damaged, not compressed with gzip, or too large")
        broken = browser.work / "broken.off"
        broken.write_text("OFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n")
        browser.open_file(broken)
        browser.wait("document.getElementById('say').classList.contains('error')")
        self.assertEqual(browser.js("return document.getElementById('say').textContent"),
                         "cannot read 'broken.off', line 4: 'zero' is not a finite number in double precision")
        browser.driver.save_screenshot(str(browser.work / "error.png"))

    def test_dropped_files_are_opened(self):
        browser = self.browser
        browser.driver.get("about:blank")
        browser.driver.get(browser.address)
        gltf, data = sphere_gltf(8)
        buffer, model = browser.work / "buffer.bin", browser.work / "model.gltf"
        gltf["buffers"][0]["uri"] = buffer.name
        buffer.write_bytes(data)
        model.write_text(json.dumps(gltf))
        browser.drop(buffer, model)
        browser.enter_viewer()
        self.assertEqual(browser.js("return document.getElementById('heading').textContent"), "model.gltf")
        mesh = browser.work / "triangle.obj"
        mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        browser.drop(mesh)  # on the viewer
        browser.driver.switch_to.default_content()
        browser.wait("document.getElementById('viewer')?.contentDocument?.getElementById('heading')?.textContent === 'triangle.obj'")
        browser.enter_viewer()
        scan = browser.work / "scan.pcd"
        scan.write_text("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n0 0 0\n")
        browser.drop(scan)
        browser.driver.switch_to.default_content()
        browser.wait("document.getElementById('say').classList.contains('error')")
        self.assertEqual(browser.js("return document.getElementById('say').textContent"),
                         "cannot read 'scan.pcd': this build has no PCL, which reads .pcd files; convert it to .ply or .xyz")
        self.assertTrue(browser.driver.find_element(By.ID, "start").is_displayed())

    def test_escape_ends_a_computation_and_the_page_goes_on(self):
        browser = self.browser
        browser.open_sample(144)
        browser.js("ahm.ask_map({ row: 17 }); setTimeout(() => window.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' })), 30)")
        browser.wait("!ahm.busy")
        self.assertEqual(browser.js("return document.getElementById('status').textContent"), "cancelled")
        browser.js("ahm.ask_map({ row: 23 })")
        browser.wait("!ahm.busy")
        self.assertEqual(browser.js("return document.getElementById('spec').textContent"), "23")


class Example(unittest.TestCase):
    def test_a_click_draws_the_decal_on_the_model(self):
        if not options.example:
            self.skipTest("--example is missing")
        folder = pathlib.Path(options.example)
        write_glb(folder / "model.glb")
        write_png(folder / "decal.png")
        browser = Browser(folder)
        self.addCleanup(browser.close)
        driver = browser.driver
        driver.get(browser.address + "decal.html")
        browser.wait("document.querySelector('canvas') && performance.getEntriesByName(new URL('decal.png', location).href).length")
        time.sleep(0.5)
        before = driver.get_screenshot_as_png()
        ActionChains(driver).move_to_element_with_offset(driver.find_element(By.TAG_NAME, "canvas"), 60, -40).click().perform()
        driver.save_screenshot(str(browser.work / "example.png"))
        self.assertNotEqual(driver.get_screenshot_as_png(), before)
        self.assertEqual([entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE" and "favicon" not in entry["message"]], [])


def write_png(path, size=64):
    """A blue disc with a yellow cross, on a transparent square."""
    def pixel(x, y):
        x, y = x - size / 2 + 0.5, y - size / 2 + 0.5
        return bytes((0, 0, 0, 0) if math.hypot(x, y) > 0.45 * size else (255, 220, 0, 255) if min(abs(x), abs(y)) < 4 else (0, 40, 200, 255))
    rows = b"".join(b"\0" + b"".join(pixel(x, y) for x in range(size)) for y in range(size))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", size, size, 8, 6, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def sphere_gltf(n):
    """A sphere with positions and normals, and the bytes of its buffer."""
    points = [(math.sin(math.pi * i / n) * math.cos(math.pi * j / n), math.cos(math.pi * i / n), math.sin(math.pi * i / n) * math.sin(math.pi * j / n))
              for i in range(1, n) for j in range(2 * n + 1)]  # the first meridian twice, as at seams of textures
    at = lambda i, j: i * (2 * n + 1) + j
    corners = [c for i in range(n - 2) for j in range(2 * n)
               for c in (at(i, j), at(i, j + 1), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j))]
    positions = b"".join(struct.pack("<3f", *p) for p in points)
    data = positions + struct.pack(f"<{len(corners)}I", *corners)
    vectors = {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]}
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 0}}],
            "accessors": [vectors, {"bufferView": 1, "componentType": 5125, "count": len(corners), "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": len(positions)}, {"buffer": 0, "byteOffset": len(positions), "byteLength": 4 * len(corners)}],
            "buffers": [{"byteLength": len(data)}]}, data


def write_glb(path):
    gltf, data = sphere_gltf(30)
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<3I", 0x46546C67, 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(data), b"BIN\0") + data)


def measure():
    browser = Browser()
    begin = time.perf_counter()
    browser.open_sample(144)
    print(f"the page opens, generates the mesh, and draws the first map: {time.perf_counter() - begin:.2f} s")
    reopened = """const done = arguments[0], begin = performance.now();
        parent.ahm.open(parent.ahm.files).then(() => { opened = performance.now() - begin; return ahm.server.map("map", {source: {row: 17}, method: "polar", radius: null}); })
          .then(() => done([opened, performance.now() - begin])); let opened;"""
    opened, mapped = browser.driver.execute_async_script(reopened)
    print(f"a new worker opens the file: {opened:.0f} ms; first map after {mapped:.0f} ms")
    timed = """const done = arguments[1], begin = performance.now();
        ahm.server.map("map", arguments[0]).then(() => done(performance.now() - begin))"""
    for method in ("polar", "exact", "heat"):
        times = [browser.driver.execute_async_script(timed, {"source": {"row": 5000 * k + 17}, "method": method, "radius": None}) for k in range(8)]
        print(f"{method}: first {times[0]:.0f} ms, fastest of seven more {min(times[1:]):.0f} ms")
    browser.close()


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--ahm", help="the program to compare with")
    parser.add_argument("--site", required=True)
    parser.add_argument("--example", help="folder of web/examples/decal.html, with its packages")
    parser.add_argument("--work", required=True)
    parser.add_argument("--measure", action="store_true")
    options, rest = parser.parse_known_args()
    if options.measure:
        measure()
    else:
        unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
