"""Texture transfer by two log maps: the value at (u, v) on one surface is copied to (u, v) on the other.

    python3 04_texture_transfer.py [--level N]
"""

import argparse

import numpy as np

import ahm


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", type=int, default=5)
    options = parser.parse_args()

    V, F = ahm.shapes.sphere(options.level)
    ball = ahm.TriangleMesh(V, F)
    egg = ahm.TriangleMesh(V * [1, 1, 1.25], F)
    top_of_ball, top_of_egg = int(np.argmax(V[:, 2])), [0.0, 0.0, 1.25]
    # Both maps start at the top, with the same u axis.
    map_of_ball = ahm.log_map(ball, top_of_ball, u_axis=[1, 0, 0], radius=1.2)
    map_of_egg = ahm.log_map(egg, top_of_egg, u_axis=[1, 0, 0], radius=1.0)

    texture = np.cos(12 * map_of_ball.uv[:, 0]) * np.cos(12 * map_of_ball.uv[:, 1])  # of the rows of the ball
    found = map_of_ball.inverse(map_of_egg.uv[map_of_egg.ok])
    values = np.einsum("kc,kc->k", found.barycentric, np.nan_to_num(texture)[found.triangle])
    painted = np.full(len(egg), np.nan)
    painted[map_of_egg.ok] = np.where(found.valid, values, np.nan)

    uv = map_of_egg.uv[map_of_egg.ok]
    error = np.abs(values - np.cos(12 * uv[:, 0]) * np.cos(12 * uv[:, 1]))[found.valid]
    print(f"{np.isfinite(painted).sum()} of {len(egg)} rows painted, {map_of_egg}")
    print(f"interpolation error of the texture: mean {error.mean():.4f}, largest {error.max():.4f}")
    assert found.valid.mean() > 0.95 and error.mean() < 0.2


if __name__ == "__main__":
    main()
