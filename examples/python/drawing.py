"""Pictures of meshes and clouds by matplotlib only: flat triangles, the nearest drawn last."""

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot
from matplotlib.collections import PolyCollection


def panels(count, size=3.4):
    """A figure of square panels without axes."""
    figure, axes = pyplot.subplots(1, count, figsize=(size * count, size), squeeze=False, layout="constrained")
    for one in axes[0]:
        one.set_aspect("equal")
        one.axis("off")
    return figure, axes[0]


def camera(towards, up=(0, 0, 1)):
    """A camera matrix with the rows right, up and towards the viewer."""
    z = np.asarray(towards, float) / np.linalg.norm(towards)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def paint(axes, V, F, color, view, cmap="viridis", limits=None):
    """Draws a mesh colored by one number or RGB per vertex; numbers that are not finite are gray."""
    V, color = np.asarray(V) @ view.T, np.asarray(color, float)
    normal = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    order = np.argsort(V[F].mean(axis=1)[:, 2])
    order = order[normal[order, 2] > 0]
    if color.ndim == 1:
        low, high = limits or (np.nanmin(color), np.nanmax(color))
        known = np.isfinite(color)
        shades = pyplot.get_cmap(cmap)((np.where(known, color, low) - low) / max(high - low, 1e-300))[:, :3]
        color = np.where(known[:, None], shades, 0.75)
    light = 0.55 + 0.45 * normal[order] @ np.array([-0.4, 0.5, 0.77])
    faces = np.clip(color[F[order]].mean(axis=1) * light[:, None], 0, 1)
    axes.add_collection(PolyCollection(V[F[order]][:, :, :2], facecolors=faces, edgecolors=faces, linewidths=0.3))
    axes.autoscale_view()


def draw_line(axes, points, view, **style):
    """Draws a curve in front of the surface."""
    x, y, _ = (np.asarray(points) @ view.T).T
    axes.plot(x, y, **{"color": "black", "lw": 1.2, **style})


def draw_points(axes, points, view, **style):
    x, y, _ = (np.atleast_2d(points) @ view.T).T
    axes.scatter(x, y, zorder=3, **{"color": "crimson", "s": 18, **style})


def rings_and_sectors(m, ring, sectors=12):
    """Colors of a log map's rows: 0 and 1 alternate, 2 where the quality is below 0.5."""
    cell = (np.floor(m.distance / ring) + np.floor(sectors * (m.angle + np.pi) / (2 * np.pi))) % 2
    return np.where(m.quality < 0.5, 2.0, cell)
