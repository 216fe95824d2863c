"""Surfaces from files, and from what other packages hold."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Optional, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from ._clouds import PointCloud
from ._meshes import Compressed, PolygonMesh, TriangleMesh
from ._surfaces import Surface


def read(path: Union[str, "os.PathLike[str]"], kind: Optional[str] = None, **options: Any) -> Surface:
    """The surface in a file: .ply, .pcd, .las, .xyz, .txt, .asc, .csv, .pts, .off, .obj, .stl, .glb, .gltf, .vtp or .vtk, each also
    as .gz.

    path : its name: str, bytes or what has `__fspath__`.
    kind : "triangles", "polygons" or "cloud"; None: as the file has it. A mesh read as a cloud keeps its normals.
    options : of `TriangleMesh`, `PolygonMesh` or `PointCloud`.

    >>> import ahm, tempfile
    >>> with tempfile.NamedTemporaryFile("w", suffix=".obj") as file:
    ...     _ = file.write("v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n"), file.flush()
    ...     mesh = ahm.read(file.name)
    >>> mesh
    <ahm.TriangleMesh: 3 vertices, 1 faces>

    Raises IoError (an OSError) naming the file and what is wrong with it, and as these.
    """
    got = _core.read_file(arguments.file_name(path, "path"))
    begin, corners = got["face_begin"], got["face_vertices"]
    if kind is None:
        kind = "cloud" if begin is None else "triangles" if (np.diff(begin) == 3).all() else "polygons"
    arguments.choice(kind, "kind", ("triangles", "polygons", "cloud"))
    if kind == "cloud":
        return PointCloud(got["points"], got["normals"], **options)
    if begin is None:
        raise ValueError(f"kind: {os.fsdecode(path)} holds no faces; read it as a 'cloud'")
    if kind == "polygons":
        return PolygonMesh(got["points"], Compressed(begin, corners), **options)
    if not (np.diff(begin) == 3).all():
        raise ValueError(f"kind: {os.fsdecode(path)} holds faces with other than 3 corners; read it as 'polygons'")
    return TriangleMesh(got["points"], corners.reshape(-1, 3), **options)


def surface(thing: Any, **options: Any) -> Surface:
    """A surface of anything that has points and perhaps faces: PyVista, trimesh, Open3D, meshio, or a tuple (V, F).

    thing : a `Surface` (returned as it is); an (n, 3) array (a cloud); a tuple `(vertices, faces)`; or an object with
        `points`, `vertices` or `point.positions`, and `faces`, `regular_faces`, `triangles` or `cells_dict`.
    options : of the class that it becomes.

    >>> import ahm
    >>> ahm.surface(ahm.shapes.plane(4, 3))
    <ahm.TriangleMesh: 12 vertices, 12 faces>

    Raises TypeError where it is none of these.
    """
    if isinstance(thing, Surface):
        if options:
            raise TypeError("surface: options make no sense for a surface that is made already")
        return thing
    if isinstance(thing, tuple) and len(thing) == 2:
        return _mesh(thing[0], thing[1], options)
    for name in ("points", "vertices"):
        found = _attribute(thing, name)
        if found is not None and not callable(found):
            return _mesh(arguments.array(found, name), _faces_of(thing), options, getattr(thing, "normals", None))
    for name in ("point", "vertex"):  # Open3D's tensors, of clouds and meshes
        columns = _attribute(thing, name)
        found = _attribute(columns, "positions")
        if found is not None:
            faces = _attribute(_attribute(thing, "triangle"), "indices")
            return _mesh(arguments.array(found, "positions"), None if faces is None else arguments.array(faces, "indices"), options,
                         _attribute(columns, "normals"))
    if isinstance(thing, (str, bytes, os.PathLike)):
        raise TypeError(f"surface: {thing!r:.60} is a name; ahm.read reads files")
    if (hasattr(thing, "__len__") or hasattr(thing, "__array__")) and not isinstance(thing, (dict, set)):
        return PointCloud(thing, **options)
    raise TypeError(f"surface: {type(thing).__name__} has no points, vertices or faces")


def _attribute(thing: Any, name: str) -> Any:
    """None where it is not there; Open3D's columns raise KeyError then."""
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
        regular: Any = getattr(thing, "regular_faces", None)  # PyVista; raises where faces differ
    except ValueError:
        regular = None
    if regular is not None:
        return np.asarray(regular)
    cells = getattr(thing, "cells_dict", None)  # meshio; PyVista, by VTK's numbers
    if cells is not None:
        cells = {_VTK_KINDS.get(kind, kind): block for kind, block in cells.items()}
        solid = sorted(map(str, set(cells) - {"triangle", "quad", "polygon", "vertex", "line"}))
        if solid:
            raise ValueError(f"surface: cells of the kind {solid[0]!r} are no faces; take the surface of the volume")
        kinds = [cells[kind] for kind in ("triangle", "quad", "polygon") if kind in cells]
        return [face for block in kinds for face in block] if len(kinds) != 1 else np.asarray(kinds[0])
    faces = getattr(thing, "faces", None)  # trimesh, whose triangles are positions
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
            raise ValueError(f"faces[{at}]: a face of {count} corners, but {len(flat) - at - 1} numbers follow")
        result.append(flat[at + 1 : at + 1 + count])
        at += 1 + count
    return result
