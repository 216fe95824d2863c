"""Generated figures with a torso, a head, arms and legs, for examples of learning."""

import numpy as np

import ahm

PARTS = ["torso", "head", "arms", "legs"]


def figure(random):
    """A mesh around the voxels of a body, smoothed, posed and turned, and the part of every vertex. Edges have a length of about 1.

    random : a numpy Generator, which chooses sizes, pose and rotation.
    """
    leg, arm, wide, gap = (random.integers(*low_high) for low_high in ((7, 11), (7, 11), (4, 6), (1, 3)))
    half, top = np.zeros((12, 8, leg + 21), int), leg + 11            # the body without its mirror image
    half[:wide, 2:6, leg:top] = 1
    half[:1, 3:5, top], half[:2, 2:6, top + 1 : top + 6] = 2, 2
    half[wide : wide + 3, 3:5, top - 2 : top], half[wide + 1 : wide + 3, 3:5, top - arm : top] = 3, 3
    half[gap : gap + 3, 2:5, 1:leg] = 4
    body, squares, parts = np.concatenate([half[::-1], half]), [], []
    for axis in range(3):
        for side in (0, 1):                                           # squares between a voxel and the empty one below or above it
            voxels = np.argwhere((body > 0) & (np.roll(body, 1 - 2 * side, axis) == 0))
            a, b, up = np.roll(np.eye(3, dtype=int), axis, axis=1)[[1, 2, 0] if side else [2, 1, 0]]
            squares.append((voxels + side * up)[:, None] + [0 * a, a, a + b, b])
            parts.append(np.repeat(body[tuple(voxels.T)] - 1, 4))
    corners, index = np.unique(np.concatenate(squares).reshape(-1, 3), axis=0, return_inverse=True)
    label = np.zeros(len(corners), int)
    label[index] = np.concatenate(parts)
    V, Q = corners.astype(float), index.reshape(-1, 4)
    for _ in range(3):
        total, count = np.zeros_like(V), np.zeros(len(V))
        for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
            np.add.at(total, Q[:, a], V[Q[:, b]])
            np.add.at(count, Q[:, a], 1)
        V = 0.5 * V + 0.5 * total / count[:, None]
    for part, joint in ((2, top), (3, leg)):                          # limbs swing: sheared away from their joints
        for side in (V[:, 0] < 12, V[:, 0] >= 12):
            limb = side & (label == part)
            V[limb, :2] += np.outer(joint - V[limb, 2], random.uniform(-0.3, 0.3, 2))
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return ahm.TriangleMesh(V @ (turn * np.linalg.det(turn)).T, np.concatenate([Q[:, :3], Q[:, [0, 2, 3]]])), label
