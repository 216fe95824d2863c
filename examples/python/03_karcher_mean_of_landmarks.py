"""The Karcher mean of landmarks on a folded, brain-like surface. The mean in space does not lie on the surface.

    python3 03_karcher_mean_of_landmarks.py [--level N]
"""

import argparse

import numpy as np

import ahm


def folded_ball(level):
    V, F = ahm.shapes.sphere(level)
    folds = 0.06 * np.sin(9 * V[:, 0] + 3 * np.sin(5 * V[:, 1])) * np.cos(7 * V[:, 2])
    return V * (1 + folds)[:, None], F


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", type=int, default=5)
    options = parser.parse_args()

    brain = ahm.TriangleMesh(*folded_ball(options.level))
    solver = ahm.LogMapSolver(brain)
    rng = np.random.default_rng(3)
    near_top = np.flatnonzero(brain.points[:, 2] > 0.7)
    subjects = rng.choice(near_top, 12, replace=False)  # one landmark per subject

    mean = ahm.karcher_mean(solver, subjects)
    median = ahm.geometric_median(solver, subjects)
    in_space = brain.points[subjects].mean(axis=0)
    print(f"mean: row {mean.row}, root mean squared distance {mean.spread:.4f}, {mean.maps} log maps")
    print(f"median: row {median.row}, mean distance {median.spread:.4f}")
    print(f"the mean in space lies {brain.closest_points([in_space]).distance[0]:.3f} off the surface")

    # Variation in the tangent space of the mean: principal axes of the landmarks' coordinates.
    uv = solver.log_map(mean.row).uv[subjects]
    sigma = np.linalg.svd(uv - uv.mean(axis=0), compute_uv=False) / np.sqrt(len(subjects) - 1)
    print(f"standard deviations along the principal axes: {sigma[0]:.3f}, {sigma[1]:.3f}")
    assert mean.converged and sigma[0] < 1


if __name__ == "__main__":
    main()
