#include "ahm/polymesh/polygon_mesh_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/surface/detail/unfolded_corners.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/surface/exact/flat_triangles.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "polygon.hpp"

namespace ahm::polymesh {
namespace {

using Eigen::Vector3d;
using trimesh::TriangleMeshSurface;
using Complex = std::complex<double>;

Vec3 array(const Vector3d& v) { return {v[0], v[1], v[2]}; }

Frame frame_in_space(const Axes& axes, const Vec3& origin) {
  return {origin, array(axes.x), array(axes.y), array(axes.normal)};
}

/// Barycentric coordinates of a position projected to the plane of a triangle.
std::array<double, 3> barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double scale = 1 / power_of_two_below(std::max(largest(b - a), largest(c - a)));
  const Vec3 u = scale * (b - a), v = scale * (c - a), w = scale * (p - a);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const double area = uu * vv - uv * uv;
  const double s = (vv * wu - uv * wv) / area, t = (uu * wv - uv * wu) / area;
  return {1 - s - t, s, t};
}

/// The triangle in the refinement of a face that contains a point of the face, or is nearest to it.
FacePoint locate(const Refinement& refinement, Index face, const Vec3& position) {
  FacePoint best{0, {1, 0, 0}};
  double most = -std::numeric_limits<double>::infinity();
  for (Offset t = refinement.face_begin[face]; t < refinement.face_begin[face + 1]; ++t) {
    const auto& [a, b, c] = refinement.triangles[t];
    const auto weights =
        barycentric(position, refinement.positions[a], refinement.positions[b], refinement.positions[c]);
    const double least = std::min({weights[0], weights[1], weights[2]});
    if (!(least > most)) continue;
    most = least;
    best = {static_cast<Index>(t), {weights.begin(), weights.end()}};
  }
  double sum = 0;
  for (double& w : best.barycentric) sum += w = std::max(w, 0.0);
  for (double& w : best.barycentric) w /= sum;
  return best;
}

/// @param what  property of the faces, such as "twisted"
std::string faces_that_are(const char* what, const std::vector<Index>& faces) {
  return detail::counted(faces.size(), "face", "are") + " " + what + ", the first is face " +
         std::to_string(faces.front());
}

RowMap rows_of(const PolygonMesh& mesh) {
  return RowMap(mesh.report().vertices, mesh.vertex_count(), mesh.topology().rows());
}

/// The rows of the vertices of a refinement. Its first rows are the vertices of the mesh.
RowMap rows_of(const PolygonMesh& mesh, const RowMap& refined) {
  std::vector<RowVertex> pairs;
  for (const auto& [row, vertex] : mesh.topology().rows())
    for (Vertex v : refined.vertices(Row(vertex.index))) pairs.push_back({row, v});
  return RowMap(mesh.report().vertices, refined.vertex_count(), pairs);
}

}  // namespace

struct PolygonMeshSurface::Impl {
  PolygonMesh mesh;
  PolygonDetails details;
  std::vector<Index> face_rows;  ///< rows at the corners of the input faces
  std::vector<Index> corners;    ///< graph vertices at the stored corners
  RowMap rows;
  Frames frames;                               ///< polygons only
  std::optional<CsrGraph> polygons;            ///< empty if refined
  Refinement refinement;                       ///< refined only
  std::optional<TriangleMeshSurface> refined;  ///< empty for polygons

  explicit Impl(PolygonMesh given) : mesh(std::move(given)), face_rows(mesh.topology().given_corners()) {
    for (Index f = 0; f < mesh.face_count(); ++f)
      details.largest_face = std::max(details.largest_face, static_cast<Index>(mesh.face(f).size()));
    details.topology = mesh.report();
    details.collinear = mesh.collinear_faces();
    details.vertices = mesh.vertex_count();
  }

  void build_polygons(const PolygonOptions& options);
  void build_refined(const PolygonOptions& options);

  /// Weights in the order of the stored corners, with sum 1.
  std::vector<double> stored_weights(const FacePoint& point) const;
  Source source(Index face, std::span<const double> stored_weights, Complex u) const;
  Vector3d point(Index face, std::span<const double> stored_weights) const;
  /// The direction of the first side of the input face, in the plane of the face.
  Complex first_side(Index face) const;
  Frame frame(Index face, std::span<const double> stored_weights) const;
};

void PolygonMeshSurface::Impl::build_polygons(const PolygonOptions& options) {
  detail::Stopwatch stopwatch;
  options.progress.step("graph", 0.0);
  if (options.progress.stop.stop_requested()) throw Cancelled("cancelled while building the graph of a polygon mesh");
  frames = find_frames(mesh, options.threads);
  details.clamped = options.clamp_weights;
  CsrGraphData data = polygon_edges(mesh, frames, options, details);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    data.frames.push_back(frame_in_space(frames.vertex[v], mesh.original_position(Vertex(v))));
  details.seconds_graph = stopwatch.lap();
  options.progress.step("graph", 1.0);
  polygons.emplace(std::move(data));
  rows = rows_of(mesh);
  corners.assign(mesh.corners().begin(), mesh.corners().end());
}

void PolygonMeshSurface::Impl::build_refined(const PolygonOptions& options) {
  trimesh::MeshOptions triangles;
  triangles.intrinsic_delaunay = options.intrinsic_delaunay;
  triangles.clamp_weights = options.clamp_weights;
  triangles.threads = options.threads;
  triangles.progress = options.progress;
  refined.emplace(TriangleMeshSurface::build(refinement.positions, refinement.triangles, triangles));
  const trimesh::MeshDetails& d = refined->details();
  details.refined = true;
  details.virtual_vertices = static_cast<Index>(refinement.positions.size()) - mesh.vertex_count();
  details.flips = d.flips;
  details.mollification = d.mollification;
  details.seconds_checks = d.seconds_checks;
  details.seconds_delaunay = d.seconds_delaunay;
  details.seconds_graph = d.seconds_graph;
  details.merged_vertices = d.merged_vertices;
  rows = rows_of(mesh, refined->rows());
  for (Index v : mesh.corners()) {
    const std::optional<Vertex> vertex = refined->rows().vertex(Row(v));
    corners.push_back(vertex ? vertex->index : 0);  // only in faces without area: any vertex
  }
}

std::vector<double> PolygonMeshSurface::Impl::stored_weights(const FacePoint& point) const {
  const std::size_t m = point.barycentric.size();
  double sum = 0;
  for (double w : point.barycentric) sum += std::max(w, 0.0);
  std::vector<double> stored(m);
  for (std::size_t c = 0; c < m; ++c)
    stored[mesh.topology().stored_corner(point.face, static_cast<Index>(c))] =
        std::max(point.barycentric[c], 0.0) / sum;
  return stored;
}

Vector3d PolygonMeshSurface::Impl::point(Index face, std::span<const double> stored_weights) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t c = 0; c < stored_weights.size(); ++c)
    sum += stored_weights[c] * Vector3d(mesh.position(Vertex(mesh.face(face)[c])).data());
  return sum;
}

Complex PolygonMeshSurface::Impl::first_side(Index face) const {
  if (!mesh.reversed(face)) return 1.0;  // the x axis
  const auto corners = mesh.face(face);
  const Complex side = frames.face[face].components(Vector3d(mesh.position(Vertex(corners.back())).data()) -
                                                    Vector3d(mesh.position(Vertex(corners.front())).data()));
  return std::abs(side) > 0 ? side / std::abs(side) : 1.0;
}

Source PolygonMeshSurface::Impl::source(Index face, std::span<const double> stored_weights, Complex u) const {
  const Vector3d p = point(face, stored_weights);
  const Axes& plane = frames.face[face];
  Source source(2);
  for (std::size_t c = 0; c < stored_weights.size(); ++c) {
    const auto corner = static_cast<std::size_t>(mesh.face_begin()[face]) + c;
    const Index v = mesh.corners()[corner];
    // In the frame of the source, scaled to the length of the chord like the edges.
    const Vector3d chord = Vector3d(mesh.position(Vertex(v)).data()) - p;
    Complex z = plane.components(chord) * std::conj(u);
    if (std::abs(z) > 0.1 * chord.norm()) z *= chord.norm() / std::abs(z);
    z *= polygons->length_unit();
    // From the plane of the face to the vertex: turn^-1 w, or turn^-1 conj(w) if the corner is mirrored.
    auto carried = [&](Complex w) {
      return std::conj(frames.turn[corner]) * (mesh.mirrored(static_cast<Offset>(corner)) ? std::conj(w) : w);
    };
    const Complex x = carried(u), y = carried(u * Complex(0, 1));
    source.add(Vertex(v), stored_weights[c], std::array{z.real(), z.imag()},
               std::array{x.real(), y.real(), x.imag(), y.imag()});
  }
  return source;
}

Frame PolygonMeshSurface::Impl::frame(Index face, std::span<const double> stored_weights) const {
  Vec3 origin{0, 0, 0};
  for (std::size_t c = 0; c < stored_weights.size(); ++c)
    origin = origin + stored_weights[c] * mesh.original_position(Vertex(mesh.face(face)[c]));
  const Axes& plane = frames.face[face];
  const Complex u = first_side(face);
  const Vector3d x = u.real() * plane.x + u.imag() * plane.y;
  return frame_in_space({x, plane.normal.cross(x), plane.normal}, origin);
}

PolygonMeshSurface::PolygonMeshSurface(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
PolygonMeshSurface::~PolygonMeshSurface() = default;
PolygonMeshSurface::PolygonMeshSurface(PolygonMeshSurface&&) noexcept = default;
PolygonMeshSurface& PolygonMeshSurface::operator=(PolygonMeshSurface&&) noexcept = default;

const CsrGraph& PolygonMeshSurface::graph() const& {
  return impl_->refined ? impl_->refined->graph() : *impl_->polygons;
}
const RowMap& PolygonMeshSurface::rows() const { return impl_->rows; }
std::span<const Vec3> PolygonMeshSurface::positions() const { return impl_->mesh.input_positions(); }
FaceList PolygonMeshSurface::faces() const { return {impl_->mesh.face_begin(), impl_->face_rows}; }
std::span<const Index> PolygonMeshSurface::corner_vertices() const { return impl_->corners; }
const PolygonDetails& PolygonMeshSurface::details() const noexcept { return impl_->details; }
const PolygonMesh& PolygonMeshSurface::mesh() const noexcept { return impl_->mesh; }

PolygonMeshSurface PolygonMeshSurface::build(PolygonMesh mesh, const PolygonOptions& options, double seconds_checks) {
  auto impl = std::make_unique<Impl>(std::move(mesh));
  impl->details.seconds_checks = seconds_checks;
  if (options.discretization != Discretization::polygons) {
    impl->refinement = impl->mesh.refined();
    impl->details.twisted = impl->refinement.folded;
  }
  const std::vector<Index>& bad = impl->details.twisted;
  if (options.discretization == Discretization::refined && !bad.empty())
    throw InvalidGeometry("twisted_faces", faces_that_are("twisted", bad), "use Discretization::polygons");
  if (options.discretization == Discretization::polygons || !bad.empty()) {
    impl->refinement = {};
    impl->build_polygons(options);
  } else {
    impl->build_refined(options);
  }
  return PolygonMeshSurface(std::unique_ptr<const Impl>(std::move(impl)));
}

PolygonMeshSurface PolygonMeshSurface::build(PolygonMesh mesh, const PolygonOptions& options) {
  return detail::with_memory_check("building the graph of a polygon mesh",
                                   [&] { return build(std::move(mesh), options, 0.0); });
}

PolygonMeshSurface PolygonMeshSurface::build(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                             std::span<const Index> face_vertices, const PolygonOptions& options) {
  return detail::with_memory_check("building the graph of a polygon mesh", [&] {
    detail::Stopwatch stopwatch;
    options.progress.step("checks", 0.0);
    PolygonMesh mesh =
        PolygonMesh::from_faces(positions, face_begin, face_vertices, options.non_manifold, options.counts_as_reversed);
    return build(std::move(mesh), options, stopwatch.lap());
  });
}

SurfaceSource PolygonMeshSurface::source_in_face(const FacePoint& point, const std::optional<Vec3>& u_axis) const {
  if (impl_->refined) {
    const Vec3 place = position(point);
    const auto corners = faces()[point.face];
    const Vec3 u = u_axis ? *u_axis : positions()[corners[1]] - positions()[corners[0]];
    return impl_->refined->source(locate(impl_->refinement, point.face, place), u);
  }
  const std::vector<double> weights = impl_->stored_weights(point);
  const Frame frame = impl_->frame(point.face, weights);
  const Axes& plane = impl_->frames.face[point.face];
  const Vec3 axis = u_axis ? *u_axis : frame.x;
  const auto [x, y] = projected(array(plane.x), array(plane.y), axis, "in face " + std::to_string(point.face));
  const Complex u = Complex(x, y) / std::hypot(x, y);
  return {impl_->source(point.face, weights, u), frame.origin, u_axis ? turned(frame, *u_axis) : frame, std::nullopt};
}

Sample PolygonMeshSurface::sample_in_face(const LogMap& map, const FacePoint& point) const {
  if (!impl_->refined) return Surface::sample_in_face(map, point);
  return impl_->refined->at(map, locate(impl_->refinement, point.face, position(point)));
}

std::vector<Vec2> PolygonMeshSurface::to_corners(const LogMap& map) const {
  check_map(map);
  const PolygonMesh& mesh = impl_->mesh;
  const std::vector<Vec2> places = flat_faces(mesh);
  const std::vector<Vec2> stored = detail::unfolded_corners(
      mesh.topology().half_edges(), {impl_->corners, places, mesh.length_unit(), mesh.report().orientable}, map);
  std::vector<Vec2> result(stored.size());
  for (Index f = 0; f < mesh.face_count(); ++f)
    for (std::size_t c = 0; c < mesh.face(f).size(); ++c) {
      const auto begin = static_cast<std::size_t>(mesh.face_begin()[f]);
      result[begin + c] =
          stored[begin + static_cast<std::size_t>(mesh.topology().stored_corner(f, static_cast<Index>(c)))];
    }
  return result;
}

FlatTriangles PolygonMeshSurface::flat_triangles() const {
  if (impl_->refined && impl_->details.collinear.empty()) return impl_->refined->flat_triangles();
  if (!impl_->details.collinear.empty())
    throw InvalidGeometry("collinear_faces",
                          "exact geodesics need faces with an area; " +
                              faces_that_are("collinear, all corners on one line", impl_->details.collinear),
                          "remove such faces, or map by heat");
  if (!impl_->details.twisted.empty())
    throw InvalidArgument("no_flat_triangles",
                          "exact geodesics need flat faces; " + faces_that_are("twisted", impl_->details.twisted),
                          "map by heat");
  throw InvalidArgument("polygons_not_refined", "exact geodesics need polygons refined to triangles",
                        "use Discretization::refined, or map by heat");
}

exact::MeshPoint PolygonMeshSurface::flat_point_in_face(const FacePoint& point) const {
  if (!impl_->refined) return Surface::flat_point_in_face(point);
  return impl_->refined->flat_point(locate(impl_->refinement, point.face, position(point)));
}

Report PolygonMeshSurface::report() const {
  const PolygonDetails& d = details();
  Report report{{"discretization", std::string_view(d.refined ? "refined" : "polygons")},
                {"vertices", d.vertices},
                {"faces", d.topology.faces},
                {"largest_face", d.largest_face}};
  const auto append = [&](const Report& more) { report.insert(report.end(), more.begin(), more.end()); };
  append(figures(d.topology));
  if (d.refined)
    append({{"virtual_vertices", d.virtual_vertices},
            {"flips", d.flips},
            {"merged_vertices", d.merged_vertices},
            {"mollification", d.mollification},
            {"seconds.checks", d.seconds_checks},
            {"seconds.delaunay", d.seconds_delaunay},
            {"seconds.graph", d.seconds_graph}});
  else
    append({{"nonplanar_faces", d.nonplanar_faces},
            {"degenerate_faces", d.degenerate_faces},
            {"negative_weights", d.negative_weights},
            {"seconds.graph", d.seconds_graph}});
  return report;
}

std::vector<Warning> PolygonMeshSurface::warnings() const {
  const PolygonDetails& d = details();
  std::vector<Warning> result = ahm::warnings(d.topology);
  const auto warn_of = [&](std::string_view id, const std::vector<Index>& faces) {
    if (!faces.empty())
      result.push_back({id, {static_cast<double>(faces.size()), static_cast<double>(faces.front())}, {}});
  };
  warn_of("collinear_faces", d.collinear);
  if (impl_->refined) {
    const std::vector<Warning> topology_warnings = ahm::warnings(impl_->refined->details().topology);
    for (Warning& warning : impl_->refined->warnings())
      if (std::ranges::find(topology_warnings, warning.id, &Warning::id) == topology_warnings.end() &&
          warning.id != "collinear_faces")
        result.push_back(std::move(warning));  // collinear triangles of a refinement are no input faces
    return result;
  }
  if (!d.clamped && d.negative_weights > 0)
    result.push_back({"negative_weights", {static_cast<double>(d.negative_weights)}, {}});
  if (d.longest_edge > 1e6 * d.shortest_edge) result.push_back({"edge_lengths", {d.shortest_edge, d.longest_edge}, {}});
  warn_of("twisted_faces", d.twisted);
  return result;
}

}  // namespace ahm::polymesh
