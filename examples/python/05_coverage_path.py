"""A tool path over a curved panel: parallel lines in log coordinates, mapped to the surface with normals and headings.

    python3 05_coverage_path.py [--size N] [--save PATH.csv]
"""

import argparse

import numpy as np

import ahm


def panel(n):
    V, F = ahm.shapes.plane(n, n, 2.0 / (n - 1))
    x, y = V[:, 0] - 1, V[:, 1] - 1
    return np.stack([x, y, 0.25 * np.sin(1.5 * x) * np.cos(y)], axis=1), F


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=120, help="vertices along a side")
    parser.add_argument("--save")
    options = parser.parse_args()

    mesh = ahm.TriangleMesh(*panel(options.size))
    m = ahm.log_map(mesh, [0.0, 0.0, 0.0], u_axis=[1, 0, 0])
    path = ahm.coverage(m, radius=0.8, spacing=0.05)
    length = sum(np.linalg.norm(np.diff(path.position[path.piece == k], axis=0), axis=1).sum() for k in range(path.pieces))
    bends = np.count_nonzero(path.between)
    print(f"{len(path.uv) - bends} of {path.planned} points and {bends} bends between them, in {path.pieces} pieces, length {length:.2f}")
    apart = path.spacing[np.isfinite(path.spacing)]
    print(f"lines are {apart.min():.4f} to {apart.max():.4f} apart; the requested spacing is 0.05")
    if options.save:
        np.savetxt(options.save, np.hstack([path.position, path.normal, path.heading, path.piece[:, None]]), delimiter=",",
                   header="x,y,z,nx,ny,nz,hx,hy,hz,piece", comments="")
    assert 0.03 < apart.min() and apart.max() < 0.07


if __name__ == "__main__":
    main()
