"""Surfaces from files, and from objects of other packages."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Optional

import numpy as np

from . import _arguments as arguments
from . import _core
from ._clouds import PointCloud
from ._meshes import Compressed, PolygonMesh, TriangleMesh
from ._surfaces import Surface
from .typing import FileName, SurfaceInput


def read(path: FileName, kind: Optional[str] = None, **options: object) -> Surface:
    """Reads a surface from a file.

    Formats: .ply, .pcd, .las, .xyz, .txt, .asc, .csv, .pts, .off, .obj, .stl, .glb, .gltf, .vtp and .vtk, each also compressed
    as .gz.

    path : name of the file: str, bytes or an object with `__fspath__`.
    kind : "triangles", "polygons" or "cloud"; None: according to the faces in the file. A mesh read as a cloud keeps its normals.
    options : arguments of `TriangleMesh`, `PolygonMesh` or `PointCloud`.

    >>> import ahm, tempfile
    >>> with tempfile.NamedTemporaryFile("w", suffix=".obj") as file:
    ...     _ = file.write("v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n"), file.flush()
    ...     mesh = ahm.read(file.name)
    >>> mesh
    <ahm.TriangleMesh: 3 vertices, 1 face>

    Raises IoError (an OSError) naming the file and the problem. Also raises as the class of the surface.
    """
    got = _core.read_file(arguments.file_name(path, "path"))
    given: Dict[str, Any] = dict(options)
    begin, corners = got["face_begin"], got["face_vertices"]
    if kind is None:
        kind = "cloud" if begin is None else "triangles" if (np.diff(begin) == 3).all() else "polygons"
    arguments.choice(kind, "kind", ("triangles", "polygons", "cloud"))
    if begin is None and kind != "cloud":
        raise ValueError(f"kind: {os.fsdecode(path)} contains no faces; use kind='cloud'")
    if kind == "triangles" and not (np.diff(begin) == 3).all():
        raise ValueError(f"kind: {os.fsdecode(path)} contains faces that are not triangles; use kind='polygons'")
    result: Surface
    if kind == "cloud":
        result = PointCloud(got["points"], got["normals"], **given)
    elif kind == "polygons":
        result = PolygonMesh(got["points"], Compressed(begin, corners), **given)
    else:
        result = TriangleMesh(got["points"], corners.reshape(-1, 3), **given)
    result._read_warnings = got["warnings"]
    return result


def surface(thing: SurfaceInput, **options: object) -> Surface:
    """Makes a surface from an array, a tuple (V, F), or an object of PyVista, trimesh, Open3D or meshio.

    thing : a `Surface` (returned unchanged), an (n, 3) array (a cloud), a tuple `(vertices, faces)`, or an object with points
        and perhaps faces. Points are its `points`, `vertices` or `point.positions`; faces are its `faces`, `regular_faces`,
        `triangles` or `cells_dict`.
    options : arguments of the resulting class: `TriangleMesh`, `PolygonMesh` or `PointCloud`.

    >>> import ahm
    >>> ahm.surface(ahm.shapes.plane(4, 3))
    <ahm.TriangleMesh: 12 vertices, 12 faces>

    Raises TypeError for any other object.
    """
    if isinstance(thing, Surface):
        if options:
            raise TypeError("surface: options cannot be applied to an existing surface")
        return thing
    if isinstance(thing, tuple) and len(thing) == 2:
        return _mesh(thing[0], thing[1], options)
    for name in ("points", "vertices"):
        found = _attribute(thing, name)
        if found is not None and not callable(found):
            return _mesh(arguments.array(found, name), _faces_of(thing), options, getattr(thing, "normals", None))
    for name in ("point", "vertex"):  # Open3D's tensor-based clouds and meshes
        columns = _attribute(thing, name)
        found = _attribute(columns, "positions")
        if found is not None:
            faces = _attribute(_attribute(thing, "triangle"), "indices")
            return _mesh(arguments.array(found, "positions"), None if faces is None else arguments.array(faces, "indices"), options,
                         _attribute(columns, "normals"))
    if isinstance(thing, (str, bytes, os.PathLike)):
        raise TypeError(f"surface: {thing!r:.60} is a name; read files with ahm.read")
    if (hasattr(thing, "__len__") or hasattr(thing, "__array__")) and not isinstance(thing, (dict, set)):
        return _mesh(thing, None, options)
    raise TypeError(f"surface: {type(thing).__name__} has no points, vertices or faces")


def _attribute(thing: Any, name: str) -> Any:
    """The attribute, or None if it is missing. Open3D raises KeyError for missing columns."""
    try:
        return getattr(thing, name, None)
    except KeyError:
        return None


def _mesh(points: Any, faces: Any, options: Dict[str, Any], normals: Any = None) -> Surface:
    if faces is not None and not isinstance(faces, (list, tuple)):
        faces = arguments.array(faces, "faces")
    if faces is None or (faces.size if isinstance(faces, np.ndarray) else len(faces)) == 0:
        given = None if normals is None or callable(normals) or len(normals) != len(points) else normals
        return PointCloud(points, given, **options)
    if isinstance(faces, Compressed):
        return PolygonMesh(points, faces, **options)
    if isinstance(faces, np.ndarray):
        return (TriangleMesh if faces.ndim != 2 or faces.shape[1] == 3 else PolygonMesh)(points, faces, **options)
    triangles = all(np.ndim(face) == 1 and len(face) == 3 for face in faces)
    return (TriangleMesh if triangles else PolygonMesh)(points, faces, **options)


_VTK_KINDS = {1: "vertex", 3: "line", 5: "triangle", 7: "polygon", 9: "quad"}


def _faces_of(thing: Any) -> Any:
    """The faces of an object: an (m, c) array, a list, compressed rows, or None."""
    try:
        regular: Any = getattr(thing, "regular_faces", None)  # PyVista; raises if faces have different numbers of corners
    except ValueError:
        regular = None
    if regular is not None:
        return np.asarray(regular)
    cells = getattr(thing, "cells_dict", None)  # meshio; PyVista uses VTK's numbers as keys
    if cells is not None:
        cells = {_VTK_KINDS.get(kind, kind): block for kind, block in cells.items()}
        solid = sorted(map(str, set(cells) - {"triangle", "quad", "polygon", "vertex", "line"}))
        if solid:
            raise ValueError(f"surface: cells of type {solid[0]!r} are not faces; extract the surface of the volume")
        kinds = [cells[kind] for kind in ("triangle", "quad", "polygon") if kind in cells]
        return [face for block in kinds for face in block] if len(kinds) != 1 else np.asarray(kinds[0])
    faces = getattr(thing, "faces", None)  # trimesh; its `triangles` are positions, not rows
    if faces is None:
        faces = getattr(thing, "triangles", None)  # Open3D
        return None if faces is None else np.asarray(faces)
    if isinstance(faces, np.ndarray) and faces.ndim == 1:  # PyVista: count, corners, count, corners
        return _padded_faces(faces)
    return faces


def _padded_faces(padded: np.ndarray) -> List[np.ndarray]:
    flat, at = arguments.integers(padded, "faces", 1), 0
    result = []
    while at < len(flat):
        count = int(flat[at])
        if not 0 <= count < len(flat) - at:
            raise ValueError(f"faces[{at}]: cannot read a face of {count} corners; numbers left in the array: {len(flat) - at - 1}")
        result.append(flat[at + 1 : at + 1 + count])
        at += 1 + count
    return result
