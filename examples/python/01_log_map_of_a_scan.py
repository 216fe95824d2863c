"""The log map of a scan, drawn with matplotlib: rings of equal distance and sectors of equal direction.

    python3 01_log_map_of_a_scan.py [SCAN [ROW]] [--size N] [--save PICTURE.png]
"""

import argparse

import numpy as np

import ahm


def bumpy_scan(size):
    """`size` points of a bumpy, potato-shaped surface."""
    i = np.arange(size) + 0.5
    z, turn = 1 - 2 * i / size, np.pi * (1 + 5**0.5) * i
    ball = np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    bumps = 0.1 * np.sin(3 * ball[:, 0]) * np.cos(4 * ball[:, 1]) + 0.05 * np.sin(7 * ball[:, 2])
    return ball * (1 + bumps)[:, None] * [1, 1.2, 0.9]


def draw(cloud, m, file):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (space, plane) = pyplot.subplots(1, 2, figsize=(11, 5), subplot_kw=None)
    ring = np.floor(8 * m.distance / np.nanmax(m.distance))
    sector = np.floor(6 * (m.angle + np.pi) / np.pi)
    color = (ring + sector) % 2 + 2 * (m.quality < 0.5)
    front = np.einsum("ij,j->i", cloud.normals, m.source.axes[2]) > 0  # normals of a cloud are not oriented
                                                                       # consistently
    seen = m.distance < 0.5 * np.nanmax(m.distance)
    u, v = ((cloud.points - m.source.position) @ m.source.axes[:2].T).T
    space.scatter(u[seen], v[seen], c=color[seen], s=2, cmap="viridis")
    space.set_title("from above the source")
    plane.scatter(*m.uv.T, c=color, s=2, cmap="viridis")
    plane.set_title("logarithmic map")
    for axes in (space, plane):
        axes.set_aspect("equal")
    figure.savefig(file, dpi=120)
    print(f"{file}: {int(front.sum())} points face the viewer")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scan", nargs="?")
    parser.add_argument("row", nargs="?", type=int, default=0)
    parser.add_argument("--size", type=int, default=20000)
    parser.add_argument("--save")
    options = parser.parse_args()

    cloud = ahm.read(options.scan) if options.scan else ahm.PointCloud(bumpy_scan(options.size))
    m = ahm.log_map(cloud, options.row)
    print(m)
    print(f"farthest point: {np.nanmax(m.distance):.4f} away; {100 * np.mean(m.quality > 0.5):.0f} % of the map is reliable")
    if options.save:
        draw(cloud, m, options.save)


if __name__ == "__main__":
    main()
