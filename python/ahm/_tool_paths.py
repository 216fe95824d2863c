"""Isolines, and tool paths over whole surfaces."""

from __future__ import annotations

import math
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _arguments as arguments
from . import _core
from . import _places as places
from ._options import checked
from ._progress import Progress, reporting
from ._solvers import as_body
from .typing import Array, Matrix, Source, SurfaceLike, Vector


class Isoline(NamedTuple):
    """A polyline on the faces of a surface where a function has a value. Returned by `isolines`."""

    level: float  #: value of the function
    points: np.ndarray  #: (k, 3) points on the edges, world units; a closed line does not repeat its first point
    closed: bool  #: whether the last point is joined to the first
    length: float  #: world units

    def __repr__(self) -> str:
        kind = "closed" if self.closed else "open"
        return f"<ahm.Isoline: level {self.level:g}, {arguments.counted(len(self.points), 'point')}, {kind}, length {self.length:g}>"


def isolines(surface: SurfaceLike, values: Vector, levels: Union[float, Vector, None] = None, *, every: Optional[float] = None,
             progress: Progress = None) -> List[Isoline]:
    """The curves where a function, linear in every triangle, has given values. Larger values are on their left.

    surface : a mesh or a cloud, or (points, faces); clouds have the triangles of their local triangulations.
    values : (n,) one value per row. Lines end at triangles with a NaN.
    levels : a number or (k,) numbers.
    every : instead of `levels`: all multiples of this step, > 0, within the values.
    progress : callable as in `log_map`.

    >>> import ahm
    >>> plane = ahm.shapes.plane(5, 3)
    >>> [(line.level, line.length, line.closed) for line in ahm.isolines(plane, plane[0][:, 0], [0.5, 2.5])]
    [(0.5, 2.0, False), (2.5, 2.0, False)]

    Raises ValueError naming the argument.
    """
    on = as_body(surface)
    of_rows = arguments.floats(values, "values", (None,))
    if (levels is None) == (every is None):
        raise ValueError("levels: use either levels or every")
    at = np.empty(0) if levels is None else arguments.floats(np.atleast_1d(arguments.unwrapped(levels)), "levels", (None,), finite=True)
    step = 0.0 if every is None else arguments.real(every, "every", positive=True)
    with reporting(progress) as report:
        return [Isoline(*line) for line in _core.isolines(on._body, of_rows, at, step, report)]


_KINDS = np.array(["pass", "link", "approach", "retreat", "missing"])
_COVERAGES = np.array(["covered", "gap", "no_pass", "outside_region", "no_triangle", "removed"])
_ORIGINS = ("seed", "level", "cut_locus", "boundary", "spiral")


class ToolPass(NamedTuple):
    """A pass of a `ToolPath`."""

    begin: int  #: its first pose
    end: int  #: one after its last pose
    closed: bool  #: whether it ends where it begins
    kind: str  #: "seed", "level", "cut_locus" or "boundary": why the pass is there; "spiral": several closed passes as one
    distance: float  #: distance from the seed, world units; on cut loci, boundaries and spirals the mean
    length: float  #: world units


class ToolPath(NamedTuple):
    """A path of a tool over a whole surface: k poses in order of travel. Returned by `tool_path`."""

    position: np.ndarray  #: (k, 3) positions, world units
    contact: np.ndarray  #: (k, 3) points of the surface where the poses are; equal to `position` without an offset
    axis: np.ndarray  #: (k, 3) unit vectors away from the surface: mean normals within the tool radius, with lead and tilt
    travel: np.ndarray  #: (k, 3) directions of travel, unit vectors perpendicular to the axes
    quaternion: np.ndarray  #: (k, 4) rotations (w, x, y, z) that take z to the axis and x to the travel
    pass_number: np.ndarray  #: (k,) int32 number of the pass; on links that of the next pass
    #: (k,) "pass", "link", "approach" or "retreat": the motion that ends at the pose; "missing": no link was found, so that the
    #: tool must get there by other means
    kind: np.ndarray
    arclength: np.ndarray  #: (k,) length of the path from its first pose, without missing links, world units
    passes: List[ToolPass]  #: in order of travel
    #: area, covered (share of the area within 0.6 spacings of a pass), largest_gap (in spacings), double_covered (share of
    #: the pass length), pass_length, link_length, surface_links, lifted_links, missing_links, uncovered_components
    measures: Dict[str, float]
    #: (n,) "covered" (within 0.6 spacings of a pass), or why a row is not: "gap"; "no_pass", in a component that the seed does
    #: not reach, or that is too small; "outside_region"; "no_triangle", isolated points of clouds; "removed", or used by no face
    rows: np.ndarray
    chord_error: float  #: of the options, or its default, world units

    @property
    def poses(self) -> np.ndarray:
        """(k, 4, 4) the poses as matrices, which take coordinates of the tool to those of the surface: the columns are the
        direction of travel (x), y, the tool axis (z) and the position.

        >>> import ahm
        >>> path = ahm.tool_path(ahm.shapes.plane(9, 9), 2)
        >>> path.poses.shape == (len(path.kind), 4, 4), bool((path.poses[:, :3, 2] == path.axis).all())
        (True, True)
        """
        result = np.zeros((len(self.kind), 4, 4))
        result[:, :3, 0], result[:, :3, 1] = self.travel, np.cross(self.axis, self.travel)
        result[:, :3, 2], result[:, :3, 3], result[:, 3, 3] = self.axis, self.position, 1
        return result

    def _poses(self) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        kinds = np.argmax(self.kind[:, None] == _KINDS, axis=1).astype(np.uint8)
        return self.position, self.axis, self.quaternion, self.pass_number, kinds, self.arclength

    def gcode(self, feed: float, *, axes: int = 3, units: str = "mm", blend: Optional[float] = None) -> str:
        """The path as a program in RS-274/NGC, the dialect of LinuxCNC. Lifted motions are rapid (G0), all others G1.

        feed : speed, world units per minute, > 0.
        axes : 3, the tool along z; or 5, also A and C in degrees such that the tool axis is
            (sin A sin C, sin A cos C, cos A), as in LinuxCNC's xyzac-trt, with the tool center point at X, Y, Z.
        units : "mm" or "inch". Numbers are not converted.
        blend : largest deviation by which the machine may blend corners (G64 P), world units. 0: none (G61); None: the chord
            error of the path.

        >>> import ahm
        >>> ahm.tool_path(ahm.shapes.plane(9, 9), 2, facing=[0, 0, 1]).gcode(800).splitlines()[:3]
        ['(tool path by libahm)', 'G21 G17 G40 G80 G90 G94', 'G64 P0.0100000']

        Raises ValueError for missing links, and with 3 axes for passes whose tool axis does not point up.
        """
        inches = arguments.choice(units, "units", ("mm", "inch")) == "inch"
        return _core.gcode(*self._poses(), arguments.real(feed, "feed", positive=True), arguments.integer(axes, "axes"),
                           inches, self.chord_error if blend is None else arguments.real(blend, "blend"))

    def ros_yaml(self, message: str = "PoseArray", *, frame: str = "map", feed: Optional[float] = None) -> str:
        """The path as a message of ROS 1, in YAML as `rostopic pub -f` reads it. ROS expects meters.

        message : "PoseArray" (geometry_msgs) or "Path" (nav_msgs).
        frame : frame of the coordinates.
        feed : speed for the time stamps of a Path, world units per minute; None: all stamps are 0.

        >>> import ahm
        >>> print(ahm.tool_path(ahm.shapes.plane(9, 9), 2).ros_yaml(frame="part").splitlines()[0])
        header: {seq: 0, stamp: {secs: 0, nsecs: 0}, frame_id: "part"}

        Raises ValueError naming the argument, and for missing links.
        """
        stamped = arguments.choice(message, "message", ("PoseArray", "Path")) == "Path"
        return _core.ros_yaml(*self._poses(), stamped, frame, 0.0 if feed is None else arguments.real(feed, "feed", positive=True))

    def __repr__(self) -> str:
        return (f"<ahm.ToolPath: {len(self.passes)} passes, {arguments.counted(len(self.kind), 'pose')}, "
                f"{100 * self.measures['covered']:.1f} % of the area covered>")


def _vector(value: Vector, name: str) -> np.ndarray:
    along = arguments.vector(value, name)
    if along is None:
        raise TypeError(f"{name}: expected three numbers, got None")
    return along


def _seed(seed: str, plane: Optional[Tuple[Vector, Vector]], curve: Optional[Matrix],
          line: Optional[Tuple[Source, Union[Vector, float]]], feature: Optional[float]) -> Tuple[str, np.ndarray]:
    """The kind of the seed, and its points and vectors. A feature edge, and a line at an angle, have none."""
    if sum(given is not None for given in (plane, curve, line, feature)) + (seed != "auto") > 1:
        raise ValueError("seed: use one of seed, plane, curve, line and feature")
    if feature is not None:
        return "feature", np.empty((0, 3))
    if line is not None:
        if not isinstance(line, (tuple, list)) or len(line) != 2:
            raise TypeError("line: expected (point, direction)")
        direction = arguments.unwrapped(line[1])
        return "line", np.empty((0, 3)) if np.ndim(direction) == 0 else _vector(direction, "line[1]")[None]
    if plane is not None:
        point, normal = plane
        return "plane", np.stack([arguments.floats(point, "plane[0]", (3,), finite=True), _vector(normal, "plane[1]")])
    if curve is not None:
        return "curve", arguments.floats(curve, "curve", (None, 3), finite=True)
    return arguments.choice(seed, "seed", ("auto", "boundary")), np.empty((0, 3))


def _require(name: str, given: bool, of: str, is_there: bool) -> None:
    """Rejects an argument without the one that it belongs to."""
    if given and not is_there:
        raise ValueError(f"{name}: has no effect without {of}")


def tool_path(surface: SurfaceLike, spacing: float, *, seed: str = "auto", plane: Optional[Tuple[Vector, Vector]] = None,
              curve: Optional[Matrix] = None, closed: bool = False, line: Optional[Tuple[Source, Union[Vector, float]]] = None,
              feature: Optional[float] = None, near: Optional[Source] = None, rows: Union[Array, Sequence[bool], None] = None,
              facing: Optional[Vector] = None, max_angle: Optional[float] = None, inside: Optional[Matrix] = None,
              outside: Optional[Matrix] = None, center: Optional[Source] = None, radius: Optional[float] = None, spiral: bool = False,
              step: Optional[float] = None, chord_error: Optional[float] = None, tool_radius: Optional[float] = None,
              clearance: Optional[float] = None, max_link: Optional[float] = None, one_way: bool = False,
              lead: float = 0, tilt: float = 0, offset: Optional[float] = None,
              threads: Optional[int] = None, progress: Progress = None) -> ToolPath:
    """Covers a whole surface, closed or not, with passes at equal geodesic distance, joined by links.

    surface : a mesh or a cloud, or (points, faces).
    spacing : geodesic distance between neighboring passes, > 0, world units.
    seed : "auto", passes parallel to the section with a plane through the center along the longest direction; or
        "boundary", parallel to the longest boundary loop, from half a spacing on.
    plane : (point, normal): passes parallel to the section with this plane.
    curve : (n, 3) positions on the surface: passes parallel to the curve through them; `closed` joins its ends.
    line : (point, direction): passes parallel to the straight line through a point of the surface, in both directions. The
        point is a row, a position, `(face, barycentric)`, or `((row, row), t)`; the direction a vector in space, or an angle
        in radians from the u axis of a log map at the point, counterclockwise.
    feature : angle in radians, in (0, pi]: passes parallel to the longest feature edge of each component, where the normal turns
        by this angle or more.
    near : a point, as in `line`: passes parallel to the feature edge nearest to it.
    rows : (n,) bool, cover only triangles whose corners are all True.
    facing, max_angle : cover only what faces a direction, a vector in space: [0, 0, 1] is the upper side of a part. The angle
        between the normal and the vector is at most `max_angle` (radians, in [0, pi]; None: pi / 4). What other parts hide is
        covered, too.
    inside, outside : (n, 3) positions on the surface. Cover only one side of the closed curve through them. The largest part
        into which it divides the surface is the outside, the others are the inside.
    center, radius : cover only triangles within this distance along the surface of a point, as in `line`.
    spiral : joins consecutive closed passes to spirals, which move by one spacing per turn. Passes that are open, or split,
        remain separate.
    step : longest distance between poses; None: a quarter of the spacing.
    chord_error : largest distance of a pass from the chord between poses; None: a 200th of the spacing.
    tool_radius : the tool axis is the mean normal within this radius; None: half of the spacing.
    clearance : height of lifted links over the surface; None: the spacing.
    max_link : longest link on the surface, longer ones are lifted; None: three spacings.
    one_way : all passes run in the direction of the seed.
    lead, tilt : angles by which the tool axis leans toward the travel, and to its left, radians, within (-pi/2, pi/2).
    offset : distance of the poses from the surface, as the center of a ball of this radius; loops in concave places are
        removed.
    threads : 0 or None: one per core. The result does not depend on it.
    progress : callable as in `log_map`.

    >>> import ahm
    >>> path = ahm.tool_path(ahm.shapes.sphere(3), 0.25)
    >>> path.measures["covered"] > 0.99, path.measures["largest_gap"] < 1.25, path.measures["missing_links"]
    (True, True, 0)

    Raises ValueError naming the argument, also for a spacing larger than the region and for an empty region.
    """
    on = as_body(surface)
    apart = arguments.real(spacing, "spacing", positive=True)
    kind, points = _seed(seed, plane, curve, line, feature)
    start = None
    turn = 0.0
    if line is not None:
        start = places.point(line[0], "line[0]", on)
        turn = turn if len(points) else arguments.real(line[1], "line[1]")
    if feature is not None:
        start = None if near is None else places.point(near, "near", on)
        turn = arguments.real(feature, "feature")
    mask = np.empty(0, np.uint8)
    if rows is not None:
        given = np.asarray(arguments.unwrapped(rows))
        if given.dtype != bool or given.ndim != 1:
            raise ValueError(f"rows: expected an array of bool, one per row, got {arguments.describe(rows, given)}")
        mask = np.ascontiguousarray(given, dtype=np.uint8)
    toward = arguments.vector(facing, "facing")
    is_closed_curve = arguments.flag(closed, "closed")
    _require("closed", is_closed_curve, "curve", curve is not None)
    _require("near", near is not None, "feature", feature is not None)
    _require("max_angle", max_angle is not None, "facing", facing is not None)
    _require("radius", radius is not None, "center", center is not None)
    _require("center", center is not None, "radius", radius is not None)
    middle = None if center is None else places.point(center, "center", on)
    angle = math.pi / 4 if max_angle is None else arguments.real(max_angle, "max_angle")
    within, without = (np.empty((0, 3)) if side is None else arguments.floats(side, name, (None, 3), finite=True)
                       for name, side in (("inside", inside), ("outside", outside)))
    lengths = {"chord_error": chord_error, "tool_radius": tool_radius, "clearance": clearance, "max_link": max_link,
               "offset": offset, "radius": radius}
    options = checked(step=step, threads=threads)
    options["one_way"], options["spiral"] = arguments.flag(one_way, "one_way"), arguments.flag(spiral, "spiral")
    options["lead"], options["tilt"] = arguments.real(lead, "lead"), arguments.real(tilt, "tilt")
    for name, length in lengths.items():
        if length is not None:
            options[name] = arguments.real(length, name, positive=True)
    with reporting(progress) as report:
        (position, contact, axis, travel, quaternion, number, motion, arclength, passes, measures, coverage,
         error) = _core.tool_path(
            on._body, apart, kind, points, is_closed_curve, start, turn, mask,
            np.empty(0) if toward is None else toward, angle, within, without, middle, options, report)
    made = [ToolPass(begin, end, is_closed, _ORIGINS[origin], distance, length)
            for begin, end, is_closed, origin, distance, length in passes]
    return ToolPath(position, contact, axis, travel, quaternion, number, _KINDS[motion], arclength, made, measures,
                    _COVERAGES[coverage], error)
