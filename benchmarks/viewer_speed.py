#!/usr/bin/env python3
"""Measures the viewer on large clouds and meshes, in a headless Chromium that draws on the processor.

    /usr/bin/python3 benchmarks/viewer_speed.py --ahm build/release/bin/ahm --points 1000000 [--mesh] [--shot view.png]

Writes a bumpy sphere of the requested size, opens it with `ahm view`, and prints seconds. Debian: chromium chromium-driver
python3-selenium python3-numpy.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import numpy as np
from selenium import webdriver
from selenium.webdriver.chrome.service import Service


def bumpy(directions):
    """Points on a bumpy sphere of radius about 1: (n, 3), one in the direction of each unit vector of `directions`."""
    x, y, z = directions.T
    return directions * (1 + 0.1 * np.sin(5 * x + 2 * y) * np.cos(4 * z) + 0.05 * np.sin(9 * y))[:, None]


def write_cloud(path, n):
    """Writes the points of a Fibonacci lattice, moved by a tenth of their spacing."""
    k = np.arange(n) + 0.5
    z, phi = 1 - 2 * k / n, k * np.pi * (1 + 5 ** 0.5)
    r = np.sqrt(1 - z * z)
    directions = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    directions += np.random.default_rng(1).normal(scale=0.1 * (4 * np.pi / n) ** 0.5, size=directions.shape)
    write_ply(path, bumpy(directions / np.linalg.norm(directions, axis=1)[:, None]), None)


def write_mesh(path, n):
    """Writes triangles between m meridians and m / 2 parallels."""
    m = round((2 * n) ** 0.5)
    theta, phi = np.meshgrid(np.pi * (np.arange(m // 2) + 0.5) / (m // 2), 2 * np.pi * np.arange(m) / m, indexing="ij")
    points = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(m // 2 - 1), np.arange(m), indexing="ij")
    a, b, c, d = i * m + j, i * m + (j + 1) % m, (i + 1) * m + j, (i + 1) * m + (j + 1) % m
    write_ply(path, bumpy(points), np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, c, b), (b, c, d))]))


def write_ply(path, points, faces):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property float {c}\n" for c in "xyz")
    if faces is not None:
        header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    with open(path, "wb") as file:
        file.write((header + "end_header\n").encode())
        file.write(points.astype("<f4").tobytes())
        if faces is not None:
            rows = np.empty(len(faces), dtype=[("corners", "u1"), ("v", "<i4", 3)])
            rows["corners"], rows["v"] = 3, faces
            file.write(rows.tobytes())


def browser(options, folder):
    chrome = webdriver.ChromeOptions()
    chrome.binary_location = options.chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--window-size=1366,768", "--no-first-run", f"--user-data-dir={folder}/profile"):
        chrome.add_argument(argument)
    driver = webdriver.Chrome(service=Service(options.driver), options=chrome)
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 1366, "height": 768, "deviceScaleFactor": 1, "mobile": False})
    driver.set_page_load_timeout(600)
    driver.set_script_timeout(600)
    return driver


# Turns the view by whole pictures, each finished before the next. Returns milliseconds per picture while it turns and for
# one at rest.
TURN = """
  const done = arguments[arguments.length - 1], stage = ahm.stage, gl = stage.renderer.getContext(), times = [];
  const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  let last = performance.now(), count = 0;
  stage.on_draw = () => {
    finish();
    times.push(performance.now() - last);
    last = performance.now();
    if (++count < 60) return stage.turn(0.03, 0);
    stage.on_draw = null;
    const turned = times.slice(20).sort((a, b) => a - b), begin = performance.now();
    clearTimeout(stage.rest);
    stage.is_moving = false;
    stage.draw();
    finish();
    done([turned[turned.length >> 1], turned[Math.floor(0.95 * turned.length)], performance.now() - begin, stage.quality]);
  };
  stage.turn(0.03, 0);"""

# Sends a request and waits until its answer is on the screen.
ASK = """
  const done = arguments[arguments.length - 1], begin = performance.now();
  (async () => {
    %s
    ahm.stage.draw();
    done([(performance.now() - begin) / 1000, document.getElementById("status").textContent]);
  })();"""

REQUESTS = {
    "map of another point": "await ahm.ask_map({ row: Math.floor(ahm.stage.surface.rows / 3) });",
    "map of a third": "await ahm.ask_map({ row: Math.floor(ahm.stage.surface.rows / 3) + 50 });",
    "tool path there": "ahm.tool = 'coverage'; await ahm.attempt(() => ahm.ask_coverage()); ahm.tool = 'map';",
    "stroke in the middle": """const s = ahm.stage; ahm.picked = [];
        for (let k = 0; k < 30; ++k) { const h = s.pick(s.width / 2 + k, s.height / 2); if (h) ahm.picked.push(h); }
        await ahm.ask_stroke(ahm.picked.map((h) => h.source));""",
    "value under the pointer": "ahm.panel.show_values(ahm.stage.pick(ahm.stage.width / 2, ahm.stage.height / 2));",
}


def cpu_seconds(process):
    """Processor time of a running process since its start, seconds."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def peak_megabytes(process):
    lines = pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024


def measure(options, folder):
    file = pathlib.Path(folder) / "shape.ply"
    (write_mesh if options.mesh else write_cloud)(file, options.points)
    begin = time.perf_counter()
    process = subprocess.Popen([options.ahm, "view", str(file), "--no-browser"], stdout=subprocess.PIPE, text=True)
    try:
        address = process.stdout.readline().strip()
        print(f"served after {time.perf_counter() - begin:.1f} s, of processor time {cpu_seconds(process):.1f} s", flush=True)
        driver = browser(options, folder)
        try:
            show(driver, address, process, options.shot)
        finally:
            driver.quit()
        print(f"memory of the program, at most {peak_megabytes(process):.0f} MB")
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait()


def show(driver, address, process, shot):
    begin, before = time.perf_counter(), cpu_seconds(process)
    driver.get(address)
    first = 0.0
    while not driver.execute_script("return !!(window.ahm && ahm.stage.map && !ahm.busy)"):
        if not first and driver.execute_script("return !!window.ahm"):
            first = time.perf_counter() - begin
        time.sleep(0.05)
    print(f"surface on the screen after {first:.1f} s, first map after {time.perf_counter() - begin:.1f} s"
          f" (the program: {cpu_seconds(process) - before:.1f} s of processor time)", flush=True)
    for name, request in REQUESTS.items():
        before = cpu_seconds(process)
        seconds, status_text = driver.execute_async_script(ASK % request)
        print(f"{name}: {seconds:.2f} s (the program: {cpu_seconds(process) - before:.2f} s of processor time){'  ' + status_text if status_text and 'ms' not in status_text else ''}", flush=True)
    middle, slow, rest, share = driver.execute_async_script(TURN)
    print(f"a picture while it turns: {middle:.0f} ms, 95 of 100 below {slow:.0f} ms, of 1/{1 / share:.0f} of the "
          f"{'pixels' if driver.execute_script('return ahm.stage.surface.is_mesh') else 'points'}; at rest {rest:.0f} ms", flush=True)
    if shot:
        driver.save_screenshot(shot)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ahm", required=True)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--mesh", action="store_true", help="triangles instead of a cloud")
    parser.add_argument("--shot", help="file for a picture of the page, .png")
    parser.add_argument("--chromium", default="/usr/bin/chromium")
    parser.add_argument("--driver", default="/usr/bin/chromedriver")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        measure(parser.parse_args(), work)
