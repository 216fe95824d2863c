"""Surfaces that several tests use."""

import re

import numpy as np
import pytest

import ahm


@pytest.fixture(scope="session")
def plane():
    """13 x 11 vertices 0.25 apart, in the plane z = 0."""
    return ahm.shapes.plane(13, 11, 0.25)


@pytest.fixture(scope="session")
def sphere():
    return ahm.TriangleMesh(*ahm.shapes.sphere(3))


@pytest.fixture(scope="session")
def flat_surfaces(plane):
    """One flat rectangle in every discretization, and the positions of its rows."""
    V, F = plane
    nx = 13
    quads = np.array([[i + nx * j, i + 1 + nx * j, i + 1 + nx * (j + 1), i + nx * (j + 1)]
                      for j in range(10) for i in range(nx - 1)])
    return {
        "triangles": ahm.TriangleMesh(V, F),
        "refined": ahm.PolygonMesh(V, quads, discretization="refined"),
        "polygons": ahm.PolygonMesh(V, quads, discretization="polygons"),
        "cloud": ahm.PointCloud(V, np.tile([0.0, 0.0, 1.0], (len(V), 1))),
        "grid": ahm.Grid((13, 11), 0.25),
    }


# Names that only C++ has.
WORDS_OF_CPP = re.compile(
    r"::|std\b|bad_alloc|nullptr|\bspan\b|\w+Options\b|\boptions\.|operator ?\(|\{(true|false)\}|incompatible function|_core\b"
    r"|\b(Source|CsrGraph|Discretization|NonManifold|Vertex|Row|at_vertex|at_vertices|map_quality|row_begin|face_begin|of_points"
    r"|curvature_directions|direction_in_frame|distance_gradient|exact_map|geodesic_path|to_rows|solve_scalar|solve_vector)\b")


def words_of_cpp(error):
    """Names of C++ in the text of an exception; there should be none."""
    return [found.group() for found in WORDS_OF_CPP.finditer(str(error))]


def in_plane(surface, rows):
    """Positions of rows in the plane."""
    return np.asarray(surface.points)[rows, :2]
