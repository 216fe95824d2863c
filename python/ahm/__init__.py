"""Direction and distance along a surface, from one point to every other: logarithmic maps by the Affine Heat Method.

>>> import ahm
>>> mesh = ahm.TriangleMesh(*ahm.shapes.sphere(3))     # or ahm.read("scan.ply"), ahm.PointCloud(points), ...
>>> m = ahm.log_map(mesh, 0)                           # m.uv, m.distance, m.angle, m.status: one entry per row
>>> solver = ahm.SurfaceSolver(mesh)                   # prepares the method once, for any number of sources
>>> maps = solver.log_maps([0, 7, 12])

Arrays have one entry per row of the input: per vertex of a mesh, or per point of a cloud. Lengths and positions are in world
units, the units of the input. Floating-point results are float64. Wrong arguments raise ValueError or TypeError; the message
names the argument, the index and the value. Long computations release the interpreter lock. Ctrl-C interrupts them.
"""

from . import _interpreter  # first: loading the extension in a subinterpreter would hang

import atexit as _atexit

from . import _core, _pickles, shapes
from ._applications import Cells, Center, Stroke, cells, farthest_points, geometric_median, karcher_mean, stroke
from ._core import (Cancelled, Error, InvalidArgument, InvalidGeometry, InvalidGraph, IoError, NotPositiveDefinite,
                    ResourceExhausted)
from ._fields import (Curvature, DistanceField, Operators, curvature, distance, distance_and_gradient,
                      distance_and_nearest, extend, operators, transport)
from ._clouds import PointCloud
from ._geodesics import Path, geodesic_loop, geodesic_path, geodesic_paths, trace
from ._graphs import Graph, Grid
from ._inputs import read, surface
from ._local_maps import LocalMaps, LocalStroke, PaddedMaps, local_maps, local_stroke
from ._maps import InverseMap, InversePoints, LogMap, MapSource, Status
from ._meshes import PolygonMesh, TriangleMesh
from ._solvers import ExactGeodesics, LogMapSolver, PolarMapSolver, log_map
from ._surface_solver import SurfaceSolver
from ._surfaces import ClosestPoints, Surface, TangentGraph
from ._textures import Atlas, Coverage, Decal, atlas, coverage, decal, decal_coordinates
from ._tool_paths import Isoline, ToolPass, ToolPath, isolines, tool_path

_atexit.register(_core.end)
for _result in [_value for _value in vars().values() if isinstance(_value, type) and issubclass(_value, tuple)]:
    _result.__reduce__ = _pickles.reduced_tuple  # type: ignore[assignment]

__version__ = "0.1.0"

__all__ = [
    "Atlas", "Cancelled", "Cells", "Center", "ClosestPoints", "Coverage", "Curvature", "Decal", "DistanceField",
    "Error", "ExactGeodesics", "Graph", "Grid", "InvalidArgument", "InvalidGeometry", "InvalidGraph", "InverseMap",
    "InversePoints", "IoError", "Isoline", "LocalMaps", "LocalStroke", "LogMap", "LogMapSolver", "MapSource",
    "NotPositiveDefinite", "Operators", "PaddedMaps", "Path", "PointCloud", "PolarMapSolver", "PolygonMesh",
    "ResourceExhausted", "Status", "Stroke", "Surface", "SurfaceSolver", "TangentGraph", "ToolPass", "ToolPath",
    "TriangleMesh", "atlas", "cells",
    "coverage", "curvature", "decal",
    "decal_coordinates", "distance", "distance_and_gradient", "distance_and_nearest", "extend", "farthest_points",
    "geodesic_loop", "geodesic_path", "geodesic_paths", "geometric_median", "isolines", "karcher_mean", "local_maps",
    "local_stroke", "log_map", "operators", "read", "shapes", "stroke", "surface", "tool_path", "trace",
    "transport",
]
