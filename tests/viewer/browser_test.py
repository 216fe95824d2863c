#!/usr/bin/env python3
"""The viewer's page in a real, headless Chromium: actions of a user, and results of the library.

Exit status 77 (skipped) where python3-selenium is not installed. Screenshots are left in --work.
"""
import argparse
import csv
import json
import math
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import latitude_mesh

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError:
    print("skipped: needs python3-selenium (Debian)")
    sys.exit(77)

options = None


def bumpy_sphere(n=40):
    """Triangles of a sphere with bumps: vertices and faces."""
    points = [(0.0, 0.0, 1.2)]
    for i in range(1, n):
        for j in range(2 * n):
            theta, phi = math.pi * i / n, math.pi * j / n
            r = 1 + 0.15 * math.sin(3 * theta) * math.cos(2 * phi) + 0.2 * math.cos(theta)
            points.append((r * math.sin(theta) * math.cos(phi), r * math.sin(theta) * math.sin(phi), r * math.cos(theta)))
    points.append((0.0, 0.0, -0.8))
    return points, latitude_mesh.faces_of(n)


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(file))


class Viewer:
    """A running `ahm view`."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([options.ahm, "view", *map(str, arguments), "--no-browser"], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()

    def close(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait()
        self.process.stdout.close()


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = pathlib.Path(options.work)
        shutil.rmtree(cls.work, ignore_errors=True)
        (cls.work / "downloads").mkdir(parents=True)
        cls.points, cls.faces = bumpy_sphere()
        cls.mesh, cls.cloud = cls.work / "bumps.off", cls.work / "bumps.xyz"
        latitude_mesh.write_off(cls.mesh, cls.points, cls.faces)
        cls.cloud.write_text("".join("%r %r %r\n" % p for p in cls.points))
        chrome = webdriver.ChromeOptions()
        chrome.binary_location = options.chromium
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
                         "--enable-unsafe-swiftshader", "--window-size=1366,768", "--hide-scrollbars", "--no-first-run",
                         f"--user-data-dir={cls.work / 'profile'}"):
            chrome.add_argument(argument)
        chrome.add_experimental_option("prefs", {"download.default_directory": str((cls.work / "downloads").resolve())})
        chrome.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(service=Service(options.driver), options=chrome)
        cls.driver.set_script_timeout(120)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        shutil.rmtree(cls.work / "profile", ignore_errors=True)

    def setUp(self):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1366, "height": 768, "deviceScaleFactor": 1, "mobile": False})

    def tearDown(self):
        errors = [entry for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING") and "GPU stall" not in entry["message"] and "swiftshader" not in entry["message"].lower()]
        self.assertEqual(errors, [])

    def js(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, condition):
        WebDriverWait(self.driver, 120, 0.05).until(lambda driver: self.js("return " + condition))

    def open(self, *arguments):
        viewer = Viewer(*arguments)
        self.addCleanup(viewer.close)
        self.driver.get(viewer.address)
        self.wait("window.ahm && ahm.stage.map && !ahm.busy")

    def text(self, name):
        return self.driver.find_element(By.ID, name).get_attribute("textContent")

    def at(self, x, y):
        """A chain of actions with the pointer at a pixel of the canvas."""
        return ActionChains(self.driver, duration=0).move_to_element_with_offset(
            self.driver.find_element(By.ID, "canvas"), round(x - self.js("return ahm.stage.width") / 2), round(y - self.js("return ahm.stage.height") / 2))

    def visible_rows(self, count):
        """Visible rows and their pixels: [[row, x, y], ...], away from the marks and each other."""
        return self.js("""
            const s = ahm.stage, out = [], p = s.surface.positions;
            for (let k = 0; k < s.surface.points.length && out.length < arguments[0]; k += 37) {
              const [x, y] = s.pixel([p[3 * k], p[3 * k + 1], p[3 * k + 2]]).map(Math.round);
              if (x < 200 || y < 60 || x > s.width - 60 || y > s.height - 60) continue;
              const source = s.source_position ? s.pixel(s.source_position.toArray()) : [-1e3, 0];
              if (Math.hypot(x - source[0], y - source[1]) < 40) continue;
              const hit = s.pick(x, y);
              if (hit && hit.row === s.surface.points[k]) out.push([hit.row, x, y]);
            }
            return out;""", count)

    def settled(self):
        self.wait("!ahm.busy && !ahm.following && !ahm.stage.pending")

    def click_at(self, x, y):
        before = self.js("return ahm.server.number")
        self.at(x, y).click().perform()
        self.wait(f"ahm.server.number > {before}")
        self.settled()

    def shot(self, name):
        self.js("ahm.stage.draw()")
        self.driver.save_screenshot(str(self.work / (name + ".png")))

    def downloaded(self, name):
        file = self.work / "downloads" / name
        for _ in range(600):
            if file.exists():
                break
            time.sleep(0.1)
        content = file.read_bytes()
        file.unlink()  # the browser would number a second file of this name
        return content

    def library_rows(self, source, name="library.csv", path=None, *more):
        file = self.work / name
        subprocess.run([options.ahm, "logmap", str(path or self.mesh), "--source", source, "-o", str(file), *more], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return rows_of(file)

    def expect_map(self, rows):
        shown = self.js("const m = ahm.stage.map, s = ahm.stage.surface.scale; return [m.uv, m.distance, m.spread].map((a) => Array.from(a, (x) => x * s))")
        uv, distance, spread = shown
        largest = max(abs(float(r["distance"])) for r in rows)
        for i, row in enumerate(rows):
            for found, name in ((uv[2 * i], "u"), (uv[2 * i + 1], "v"), (distance[i], "distance"), (spread[i], "spread")):
                self.assertAlmostEqual(found, float(row[name]), delta=3e-7 * largest, msg=f"{name} of row {i}")

    def test_a_click_draws_the_map_of_the_library(self):
        self.open(self.mesh)
        row, x, y = self.visible_rows(8)[-1]
        self.click_at(x + 2, y + 1)
        source = self.text("spec")
        self.assertTrue(source.startswith("face:"), source)
        self.expect_map(self.library_rows(source))
        self.assertEqual(self.text("command"), f"ahm logmap {self.mesh} --source {source} -o map.csv --method polar")
        self.shot("mesh_polar")

    def test_hover_displays_the_row_under_the_pointer(self):
        self.open(self.mesh, "--source", 0)
        rows = self.library_rows("0")
        for row, x, y in self.visible_rows(5):
            self.at(x, y).perform()
            self.wait(f"document.getElementById('at_row').textContent === '{row}'")
            self.assertEqual(self.text("at_status"), "ok")
            for name in ("u", "v", "distance", "spread"):
                self.assertAlmostEqual(float(self.text("at_" + name)), float(rows[row][name]), delta=1e-5)
            for shown, true in zip(self.text("at_position").split(), self.points[row]):
                self.assertAlmostEqual(float(shown), true, delta=1e-5)
        self.at(230, 10).perform()
        self.wait("document.getElementById('at_row').textContent === '–'")

    def test_the_source_can_be_dragged(self):
        self.open(self.mesh)
        row, x, y = self.visible_rows(9)[-1]
        at = self.js("return ahm.stage.pixel(ahm.stage.source_position.toArray())")
        eye = self.js("return ahm.stage.camera.position.toArray()")
        chain = self.at(*at).click_and_hold()
        for k in range(1, 9):
            chain = chain.move_to_element_with_offset(self.driver.find_element(By.ID, "canvas"),
                round(at[0] + (x - at[0]) * k / 8 - self.js("return ahm.stage.width") / 2), round(at[1] + (y - at[1]) * k / 8 - self.js("return ahm.stage.height") / 2))
        chain.release().perform()
        self.settled()
        self.assertEqual(self.js("return ahm.stage.camera.position.toArray()"), eye)
        self.assertEqual(self.js("return ahm.stage.pick(arguments[0], arguments[1]).row", x, y), row)
        self.assertLess(math.dist(self.js("return ahm.stage.map.position"), self.points[row]), 0.05)
        self.expect_map(self.library_rows(self.text("spec")))

    def test_a_newer_request_replaces_older_ones(self):
        self.open(self.mesh)
        self.js("for (let k = 0; k < 20; ++k) ahm.ask_map({ row: 10 + k })")
        self.settled()
        self.assertEqual(self.text("spec"), "29")
        self.expect_map(self.library_rows("29"))
        # The browser logs the refusals (409) of the older requests.
        self.driver.get_log("browser")

    def test_export_is_the_file_of_the_command(self):
        self.open(self.mesh, "--source", 123)
        self.library_rows("123", "export.csv")
        self.driver.find_element(By.ID, "export").click()
        self.assertEqual(self.downloaded("map.csv"), (self.work / "export.csv").read_bytes())

    def expect_export(self, name):
        """The saved file equals the file of the command that the page displays."""
        self.settled()
        self.driver.find_element(By.ID, "export").click()
        command = shlex.split(self.text("command"))
        subprocess.run([options.ahm, *command[1:]], cwd=self.work, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual(self.downloaded(name), (self.work / name).read_bytes())

    def test_every_field_is_drawn(self):
        self.open(self.mesh, "--source", 0)
        self.js("ahm.stage.turn(0, 0.9)")
        self.wait("!ahm.stage.is_moving && !ahm.stage.pending")
        pictures = set()
        for field in ("polar", "grid", "distance", "spread", "quality", "normals", "none"):
            self.js("ahm.panel.set_field(arguments[0]); ahm.stage.draw()", field)
            pictures.add(self.js("return ahm.stage.canvas.toDataURL()"))
            self.shot("field_" + field)
        self.assertEqual(len(pictures), 7)

    def test_methods_and_options_change_the_map(self):
        self.open(self.mesh, "--source", 0)
        self.js("document.getElementById('method_section').open = true")
        Select(self.driver.find_element(By.ID, "method")).select_by_visible_text("exact")
        self.settled()
        self.expect_map(self.library_rows("0", "exact.csv", None, "--method", "exact"))
        self.assertIn("--method exact", self.text("command"))
        self.shot("method")
        self.js("const r = document.getElementById('radius'); r.value = 'x'; r.dispatchEvent(new Event('change'))")
        self.wait("document.getElementById('status').textContent.includes('not a positive number')")

    def test_tools_draw_on_the_surface(self):
        self.open(self.mesh)
        rows = self.visible_rows(12)
        self.js("ahm.set_tool('path')")
        for _, x, y in (rows[0], rows[-1]):
            self.at(x, y).click().perform()
        self.wait("document.getElementById('command').textContent.startsWith('ahm path')")
        self.settled()
        self.shot("path")
        self.expect_export("path.obj")
        self.js("ahm.set_tool('coverage')")
        self.wait("document.getElementById('command').textContent.startsWith('ahm coverage')")
        self.settled()
        self.shot("coverage")
        self.expect_export("path.csv")
        self.js("ahm.set_tool('whole')")
        self.wait("document.getElementById('command').textContent.includes('--whole')")
        self.settled()
        self.expect_export("whole.csv")
        Select(self.driver.find_element(By.ID, "whole_pattern")).select_by_visible_text("spiral")
        self.wait("document.getElementById('command').textContent.includes('--pattern spiral')")
        self.settled()
        self.shot("spiral")
        self.expect_export("whole.csv")
        self.js("document.getElementById('whole_pattern').value = 'raster'")
        self.js("ahm.seed = [{ row: arguments[0] }, { row: arguments[1] }]; ahm.ask_whole()", rows[0][0], rows[-1][0])
        self.wait("document.getElementById('command').textContent.includes('--seed-curve')")
        self.settled()
        self.shot("whole")
        self.js("ahm.set_tool('isolines')")
        self.wait("document.getElementById('command').textContent.startsWith('ahm isolines')")
        Select(self.driver.find_element(By.ID, "isolines_column")).select_by_visible_text("z")
        self.wait("document.getElementById('command').textContent.includes('--column z')")
        self.settled()
        self.shot("isolines")
        self.expect_export("isolines.obj")
        number = self.js("return ahm.server.number")
        self.at(*rows[0][1:]).click().perform()
        self.settled()
        self.assertEqual(self.js("return ahm.server.number"), number)  # a click makes no map here
        self.js("ahm.set_tool('stroke')")
        (_, x, y), (_, to_x, to_y) = rows[0], rows[-1]
        chain = self.at(x, y).click_and_hold()
        for k in range(1, 13):
            chain = chain.move_by_offset(round((to_x - x) * k / 12) - round((to_x - x) * (k - 1) / 12), round((to_y - y) * k / 12) - round((to_y - y) * (k - 1) / 12)).pause(0.05)
        chain.release().perform()
        self.wait("ahm.stage.map.pattern === 'grid'")
        self.settled()
        self.assertTrue(self.text("command").startswith("ahm stroke"))
        self.shot("stroke")
        row = int(self.text("at_row"))  # still under the pointer
        at_v = self.driver.find_element(By.ID, "at_v").get_attribute("title")  # all of its digits
        self.assertEqual(at_v, self.js("return Ahm.number(ahm.panel.length_of(ahm.stage.map.uv[2 * arguments[0] + 1]), 9)", row))
        self.expect_export("stroke.csv")
        self.js("ahm.set_tool('coverage')")  # a map from a point
        self.wait("document.getElementById('command').textContent.startsWith('ahm coverage')")
        self.assertEqual(self.js("return ahm.stage.map.pattern"), "polar")

    def draw_stroke(self):
        self.js("ahm.set_tool('stroke')")
        rows = self.visible_rows(12)
        self.js("ahm.ask_stroke([{ row: arguments[0] }, { row: arguments[1] }])", rows[0][0], rows[-1][0])
        self.wait("ahm.stage.map.pattern === 'grid'")
        self.settled()

    def test_a_decal_lies_on_the_map(self):
        self.open(self.mesh)
        image = self.work / "bumps_image.png"
        self.js("ahm.set_tool('decal')")
        self.shot("decal_before")
        from base64 import b64decode
        image.write_bytes(b64decode(self.js("""const c = document.createElement('canvas'); c.width = 128; c.height = 64;
            const g = c.getContext('2d'); g.fillStyle = '#ff0'; g.fillRect(0, 0, 128, 64); g.fillStyle = '#00f'; g.font = '48px sans-serif'; g.fillText('ahm', 10, 48);
            return c.toDataURL().split(',')[1]""")))
        self.driver.find_element(By.ID, "decal_file").send_keys(str(image.resolve()))
        self.wait("ahm.decal && !ahm.stage.pending")
        self.assertIn("--image bumps_image.png", self.text("command"))
        self.shot("decal")
        self.assertNotEqual((self.work / "decal.png").read_bytes(), (self.work / "decal_before.png").read_bytes())
        self.expect_export("decal.glb")
        # After a stroke the decal is where it was, not along the stroke.
        command = self.text("command")
        self.draw_stroke()
        self.assertEqual(self.js("return ahm.stage.uniforms.decal_frame.value.length()"), 0)
        self.assertTrue(self.text("command").startswith("ahm stroke"))
        self.js("ahm.set_tool('decal')")
        self.wait("document.getElementById('command').textContent.startsWith('ahm decal')")
        self.settled()
        self.assertEqual(self.text("command"), command)
        self.assertEqual(self.js("return ahm.stage.map.pattern"), "polar")
        self.shot("decal_after_stroke")

    def test_long_numbers_are_whole(self):
        points, faces = bumpy_sphere(20)
        path = self.work / "far.off"
        latitude_mesh.write_off(path, [tuple(-123456.789 + 1e-3 * x for x in p) for p in points], faces)
        self.open(path, "--source", 0)
        row, x, y = self.visible_rows(12)[5]
        self.at(x, y).perform()
        self.wait("document.getElementById('at_row').textContent !== '–'")
        for name in ("position", "u", "v", "distance", "spread", "row", "status"):
            cell = self.driver.find_element(By.ID, "at_" + name)
            self.assertTrue(self.js("""const text = document.createRange(); text.selectNodeContents(arguments[0]);
                return text.getBoundingClientRect().width <= arguments[0].clientWidth""", cell), cell.text)
        self.assertRegex(self.driver.find_element(By.ID, "at_position").get_attribute("title"), r"^(-123456\.\d+ ?){3}$")
        self.shot("numbers")

    def test_clouds_are_drawn_and_picked(self):
        self.open(self.cloud, "--source", 0)
        self.expect_map(self.library_rows("0", "cloud.csv", self.cloud))
        row, x, y = self.visible_rows(6)[-1]
        self.at(x, y).perform()
        self.wait(f"document.getElementById('at_row').textContent === '{row}'")
        self.click_at(x, y)
        self.assertEqual(self.text("spec"), str(row))
        self.shot("cloud_polar")
        self.js("ahm.panel.set_field('distance')")
        self.shot("cloud_distance")

    def test_the_file_to_send_is_the_same_page(self):
        page = self.work / "map.html"
        rows = self.library_rows("0", "static.csv", None, "--view", str(page))
        self.driver.get(page.resolve().as_uri())
        self.wait("window.ahm && ahm.stage.map && !ahm.stage.pending")
        row, x, y = self.visible_rows(5)[-1]
        self.at(x, y).perform()
        self.wait(f"document.getElementById('at_row').textContent === '{row}'")
        self.assertAlmostEqual(float(self.text("at_u")), float(rows[row]["u"]), delta=1e-5)
        self.expect_map(rows)
        self.assertFalse(self.driver.find_element(By.ID, "take").is_displayed())
        self.shot("static")

    def test_a_large_mesh_is_coarser_while_it_moves_and_looks_the_same(self):
        self.open(self.mesh)
        corners, count = self.js("""const t = Ahm.coarse_triangles(ahm.stage.surface, 12), out = new Set();
            for (let k = 0; k < t.length; k += 3) out.add([t[k], t[k + 1], t[k + 2]].sort((a, b) => a - b).join());
            return [t.length, out.size]""")
        self.assertEqual(corners, 3 * count)  # no corner occurs twice
        self.assertLess(count, len(self.faces) / 4)
        covered = """const s = ahm.stage, gl = s.renderer.getContext(), bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
            s.is_moving = arguments[0]; s.quality = 1; s.draw();
            gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
            let n = 0; for (let k = 0; k < bytes.length; k += 4) if (bytes[k] + bytes[k + 1] + bytes[k + 2] < 740) ++n;
            s.is_moving = false;
            return n;"""
        whole = self.js(covered, False)
        self.js("ahm.stage.make_coarse()")
        moving = self.js(covered, True)
        self.shot("after_moving")
        self.assertLess(abs(moving - whole), 0.02 * whole)
        self.assertEqual(self.js(covered, False), whole)

    def touch(self, kind, *points):
        self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)]})

    def test_touch_taps_turns_and_zooms(self):
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        self.addCleanup(self.driver.execute_cdp_cmd, "Emulation.setTouchEmulationEnabled", {"enabled": False})
        self.open(self.mesh)
        look = lambda: self.js("return [...ahm.stage.camera.position.toArray(), ahm.stage.camera.position.distanceTo(ahm.stage.controls.target)]")
        row, x, y = self.visible_rows(8)[-1]
        before, number = look(), self.js("return ahm.server.number")
        self.touch("touchStart", (x, y))
        self.touch("touchEnd")
        self.wait(f"ahm.server.number > {number}")
        self.settled()
        self.assertEqual(look(), before)
        self.assertEqual(self.js("return ahm.stage.pick(arguments[0], arguments[1]).row", x, y), row)
        self.expect_map(self.library_rows(self.text("spec")))
        source, number = self.text("spec"), self.js("return ahm.server.number")
        self.touch("touchStart", (300, 600))
        for k in range(1, 9):
            self.touch("touchMove", (300 + 10 * k, 600))
        self.touch("touchEnd")
        self.settled()
        turned = look()
        self.assertGreater(math.dist(turned[:3], before[:3]), 0.1)
        self.assertAlmostEqual(turned[3], before[3], delta=1e-6 * before[3])
        self.touch("touchStart", (400, 400), (500, 400))
        for k in range(1, 9):
            self.touch("touchMove", (400 - 10 * k, 400), (500 + 10 * k, 400))
        self.touch("touchEnd")
        self.settled()
        self.assertLess(look()[3], 0.9 * before[3])
        self.assertEqual((self.text("spec"), self.js("return ahm.server.number")), (source, number))
        self.shot("touch")

    def all_is_seen(self):
        return self.js("const p = document.getElementById('panel'); return p.scrollHeight <= p.clientHeight && p.scrollWidth <= p.clientWidth")

    def expect_all_seen_with_larger_letters_and_a_longer_command(self, tool):
        self.js("""document.body.style.fontSize = '14px';
            document.body.style.fontFamily = 'DejaVu Sans, Verdana';
            ahm.kept = document.getElementById('command').textContent;
            document.getElementById('command').textContent = ahm.kept + ' /a/long/path/to/a/file'.repeat(12)""")
        self.assertTrue(self.all_is_seen(), tool)
        self.assertGreater(self.js("return document.getElementById('command').clientHeight"), 28, tool)
        self.shot("panel_large_" + tool)
        self.js("document.body.removeAttribute('style'); document.getElementById('command').textContent = ahm.kept")

    def test_keyboard_theme_and_a_small_screen(self):
        self.open(self.mesh)
        body = self.driver.find_element(By.ID, "stage")
        eye = self.js("return ahm.stage.camera.position.toArray()")
        body.send_keys("\ue014")  # right
        self.assertNotEqual(self.js("return ahm.stage.camera.position.toArray()"), eye)
        body.send_keys("r")
        self.assertEqual([round(c, 6) for c in self.js("return ahm.stage.camera.position.toArray()")], [round(c, 6) for c in eye])
        body.send_keys("d")
        self.assertTrue(self.js("return ahm.stage.is_dark"))
        self.settled()
        self.shot("dark")
        self.assertTrue(self.all_is_seen())
        self.js("document.getElementById('method_section').open = true")
        for tool in ("path", "stroke", "decal", "coverage", "whole", "isolines", "map"):
            self.js("ahm.set_tool(arguments[0])", tool)
            self.settled()
            self.assertTrue(self.all_is_seen(), tool)
            self.shot("panel_" + tool)
            self.expect_all_seen_with_larger_letters_and_a_longer_command(tool)
        self.js("document.getElementById('method_section').open = false")
        # The area that a browser leaves on a small screen.
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1366, "height": 620, "deviceScaleFactor": 1, "mobile": False})
        self.wait("ahm.stage.height === 620 && !ahm.stage.pending")
        self.assertTrue(self.all_is_seen())
        self.shot("low")
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 780, "deviceScaleFactor": 2, "mobile": True})
        self.wait("ahm.stage.width === 390 && !ahm.stage.pending")
        self.shot("phone")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for name in ("ahm", "chromium", "driver", "work"):
        parser.add_argument("--" + name, required=True)
    options, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
