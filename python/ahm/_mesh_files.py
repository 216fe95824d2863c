"""Reads and writes files of meshes and clouds as arrays, with the signatures of potpourri3d."""

from __future__ import annotations

import contextlib
import os
from typing import Any, List, Optional, Sequence, Tuple

import numpy as np

from . import _arguments as arguments
from . import _core
from .typing import Faces, FileName, Matrix


def read_mesh(filename: FileName) -> Tuple[np.ndarray, np.ndarray]:
    """Reads a triangle mesh: (n, 3) vertices and (m, 3) triangles.

    >>> import ahm, ahm.potpourri3d as pp3d, tempfile
    >>> with tempfile.NamedTemporaryFile(suffix=".ply") as file:
    ...     pp3d.write_mesh(*ahm.shapes.plane(4, 3), file.name)
    ...     V, F = pp3d.read_mesh(file.name)
    >>> V.shape, F.shape
    ((12, 3), (12, 3))

    Raises IoError (an OSError) naming the file; ValueError if it contains no such mesh.
    """
    got = _core.read_file(arguments.file_name(filename, "filename"))
    begin = got["face_begin"]
    if begin is None or not (np.diff(begin) == 3).all():
        raise ValueError(f"filename: {os.fsdecode(filename)} contains no triangle mesh")
    return got["points"], got["face_vertices"].reshape(-1, 3)


def read_polygon_mesh(filename: FileName) -> Tuple[np.ndarray, List[List[int]]]:
    """Reads a polygon mesh: (n, 3) vertices, and a list of the corners of every face.

    >>> import ahm.potpourri3d as pp3d, tempfile
    >>> with tempfile.NamedTemporaryFile(suffix=".off") as file:
    ...     pp3d.write_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]], file.name)
    ...     pp3d.read_polygon_mesh(file.name)[1]
    [[0, 1, 2, 3]]

    Raises IoError (an OSError) naming the file; ValueError if it contains no such mesh.
    """
    got = _core.read_file(arguments.file_name(filename, "filename"))
    begin, corners = got["face_begin"], got["face_vertices"]
    if begin is None:
        raise ValueError(f"filename: {os.fsdecode(filename)} contains no faces")
    return got["points"], [corners[b:e].tolist() for b, e in zip(begin[:-1], begin[1:])]


def read_point_cloud(filename: FileName) -> np.ndarray:
    """Reads a point cloud: (n, 3) points.

    >>> import ahm.potpourri3d as pp3d, tempfile
    >>> with tempfile.NamedTemporaryFile(suffix=".xyz") as file:
    ...     pp3d.write_point_cloud([[0, 0, 0], [1, 2, 3]], file.name)
    ...     pp3d.read_point_cloud(file.name).tolist()
    [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]

    Raises IoError (an OSError) naming the file.
    """
    return _core.read_file(arguments.file_name(filename, "filename"))["points"]


def write_mesh(V: Matrix, F: Faces, filename: FileName, UV_coords: Optional[Matrix] = None,
               UV_type: Optional[str] = None) -> None:
    """Writes a mesh to an .obj, .off or .ply (text) file. The file is written completely or not at all.

    UV_coords are written to .obj files only. UV_type is "per-vertex" for shape (n, 2), "per-face" for shape (m, 2),
    "per-corner" for shape (corners, 2).

    >>> import ahm.potpourri3d as pp3d, tempfile
    >>> with tempfile.NamedTemporaryFile(suffix=".obj") as file:
    ...     pp3d.write_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], file.name, [[0, 0], [1, 0], [0, 1]], "per-vertex")
    ...     pp3d.read_mesh(file.name)[1].tolist()
    [[0, 1, 2]]

    Raises ValueError (wrong shape; a row out of range), NotImplementedError (another format), OSError.
    """
    points = arguments.floats(V, "V", (None, 3))
    rows = F if isinstance(F, (list, tuple)) else arguments.array(F, "F")
    faces = [arguments.integers(f, f"F[{k}]", 1, 0, len(points) - 1).tolist() for k, f in enumerate(rows)]
    ending = _ending(filename)
    if (UV_coords is None) != (UV_type is None):
        raise ValueError("UV_type: pass UV_type and UV_coords together")
    if UV_type is not None:
        arguments.choice(UV_type, "UV_type", ("per-vertex", "per-face", "per-corner"))
        if ending != ".obj":
            raise NotImplementedError(f"UV_coords: cannot be written to {ending or 'a file without extension'}; use .obj")
    lines_of_points = [" ".join(repr(float(x)) for x in p) for p in points]
    if ending == ".obj":
        lines = ["v " + row for row in lines_of_points] + _obj_faces(faces, UV_coords, UV_type, len(points))
    elif ending == ".off":
        lines = ["OFF", f"{len(points)} {len(faces)} 0", *lines_of_points, *(_counted(f) for f in faces)]
    elif ending == ".ply":
        lines = ["ply", "format ascii 1.0", *_ply_points(len(points)), f"element face {len(faces)}",
                 "property list uchar int vertex_indices", "end_header", *lines_of_points, *(_counted(f) for f in faces)]
    else:
        raise NotImplementedError(f"filename: format {ending or 'without extension'} is not supported; use .obj, .off or .ply")
    _write(filename, lines)


def write_point_cloud(V: Matrix, filename: FileName) -> None:
    """Writes a point cloud to a .ply (text), .obj or .xyz file.

    >>> import ahm.potpourri3d as pp3d, tempfile
    >>> with tempfile.NamedTemporaryFile(suffix=".xyz") as file:
    ...     pp3d.write_point_cloud([[0, 0, 0], [1, 2, 3]], file.name)
    ...     pp3d.read_point_cloud(file.name).shape
    (2, 3)

    Raises as `write_mesh`.
    """
    rows = [" ".join(repr(float(x)) for x in p) for p in arguments.floats(V, "V", (None, 3))]
    ending = _ending(filename)
    if ending not in (".ply", ".obj", ".xyz"):
        raise NotImplementedError(f"filename: format {ending or 'without extension'} is not supported; use .ply, .obj or .xyz")
    head = ["ply", "format ascii 1.0", *_ply_points(len(rows)), "end_header"] if ending == ".ply" else []
    _write(filename, head + [("v " if ending == ".obj" else "") + row for row in rows])


def _ending(filename: FileName) -> str:
    return os.path.splitext(os.fsdecode(arguments.file_name(filename, "filename")))[1].lower()


def _write(filename: Any, lines: Sequence[str]) -> None:
    name = os.path.realpath(os.fsdecode(arguments.file_name(filename, "filename")))
    part = f"{name}.{os.getpid()}.part"  # renamed when it is complete
    try:
        with open(part, "x", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        os.replace(part, name)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.remove(part)
        raise


def _counted(face: Sequence[int]) -> str:
    return " ".join(map(str, (len(face), *face)))


def _ply_points(count: int) -> List[str]:
    return [f"element vertex {count}", *(f"property double {axis}" for axis in "xyz")]


def _obj_faces(faces: Sequence[Sequence[int]], uv: Optional[Matrix], kind: Optional[str], points: int) -> List[str]:
    if uv is None:
        return ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    count = {"per-vertex": points, "per-face": len(faces)}.get(str(kind), sum(len(face) for face in faces))
    given = arguments.floats(uv, "UV_coords", (count, 2))
    lines, corner = [f"vt {float(u)!r} {float(v)!r}" for u, v in given], 0
    for f, face in enumerate(faces):
        places = {"per-vertex": face, "per-face": [f] * len(face)}.get(str(kind), range(corner, corner + len(face)))
        lines.append("f " + " ".join(f"{v + 1}/{t + 1}" for v, t in zip(face, places)))
        corner += len(face)
    return lines
