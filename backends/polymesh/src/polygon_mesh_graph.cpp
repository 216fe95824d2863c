#include "ahm/polymesh/polygon_mesh_graph.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/memory.hpp"
#include "ahm/util/stopwatch.hpp"
#include "ahm/util/text.hpp"
#include "polygon_edges.hpp"

namespace ahm::polymesh {
namespace {

using Eigen::Vector3d;
using Complex = std::complex<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Vec3 array(const Vector3d& v) { return {v[0], v[1], v[2]}; }

Frame frame_in_space(const Axes& axes, const Vec3& origin) {
  return {origin, array(axes.x), array(axes.y), array(axes.normal)};
}

/// A vector of space in a tangent plane, as a complex number of length one.
Complex direction_in(const Axes& axes, const Vec3& direction, const std::string& where) {
  const Vector3d given(direction.data());
  if (!given.allFinite() || !(given.norm() > 0))
    throw InvalidArgument("the u direction is zero or not finite; give a vector of any length > 0");
  const Complex u = axes.components(given.normalized());
  if (!(std::abs(u) > 1e-9))
    throw InvalidArgument("the u direction is perpendicular to the surface " + where + "; choose another one");
  return u / std::abs(u);
}

void add_warnings(PolygonReport& report, bool clamped) {
  report.warnings = topology_warnings(report.topology);
  auto warn = [&](auto count, const std::string& text) {
    if (count > 0) report.warnings.push_back(std::to_string(count) + text);
  };
  warn(report.degenerate_faces, " faces have almost no area");
  if (!clamped)
    warn(report.negative_weights, " edges have negative weights; far from the source heat may lose its sign");
  if (report.longest_edge > 1e6 * report.shortest_edge)
    report.warnings.push_back("edge lengths range from " + detail::number(report.shortest_edge) + " to " +
                              detail::number(report.longest_edge) + "; one diffusion time cannot suit them all");
}

}  // namespace

struct PolygonMeshGraph::Impl {
  PolygonMesh mesh;
  Frames frames;
  CsrGraph graph;
  PolygonReport report;

  /// Weights in the order of the corners as stored, with sum 1.
  std::vector<double> checked_weights(Index face, std::span<const double> weights) const;
  Source source(Index face, std::span<const double> stored_weights, Complex u) const;
  Vector3d point(Index face, std::span<const double> stored_weights) const;
  /// The direction of the first side as given, in the plane of the face.
  Complex first_side(Index face) const;
};

std::vector<double> PolygonMeshGraph::Impl::checked_weights(Index face, std::span<const double> weights) const {
  if (face < 0 || face >= mesh.face_count())
    throw InvalidArgument("face " + std::to_string(face) + " is outside [0, " + std::to_string(mesh.face_count()) +
                          ")");
  const std::size_t m = mesh.face(face).size();
  if (weights.size() != m)
    throw InvalidArgument("face " + std::to_string(face) + " has " + std::to_string(m) + " corners, but there are " +
                          std::to_string(weights.size()) + " weights");
  double sum = 0;
  for (double w : weights) {
    if (!(w >= -1e-9) || !std::isfinite(w))
      throw InvalidArgument("a corner has weight " + detail::number(w) + "; weights must be finite and >= 0");
    sum += std::max(w, 0.0);
  }
  if (!(std::abs(sum - 1) <= 1e-9)) throw InvalidArgument("the weights have sum " + detail::number(sum) + ", not 1");
  std::vector<double> stored(m);
  for (std::size_t c = 0; c < m; ++c) stored[mesh.reversed(face) ? (m - c) % m : c] = std::max(weights[c], 0.0) / sum;
  return stored;
}

Vector3d PolygonMeshGraph::Impl::point(Index face, std::span<const double> stored_weights) const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t c = 0; c < stored_weights.size(); ++c)
    sum += stored_weights[c] * Vector3d(mesh.position(mesh.face(face)[c]).data());
  return sum;
}

Complex PolygonMeshGraph::Impl::first_side(Index face) const {
  if (!mesh.reversed(face)) return 1.0;  // the x axis
  const auto corners = mesh.face(face);
  const Complex side = frames.face[face].components(Vector3d(mesh.position(corners.back()).data()) -
                                                    Vector3d(mesh.position(corners.front()).data()));
  return std::abs(side) > 0 ? side / std::abs(side) : 1.0;
}

Source PolygonMeshGraph::Impl::source(Index face, std::span<const double> stored_weights, Complex u) const {
  const Vector3d p = point(face, stored_weights);
  const Axes& plane = frames.face[face];
  Source source(2);
  for (std::size_t c = 0; c < stored_weights.size(); ++c) {
    const auto corner = static_cast<std::size_t>(mesh.face_begin()[face]) + c;
    const Index v = mesh.corners()[corner];
    // In the source's frame; at the chord's length, as the edges.
    const Vector3d chord = Vector3d(mesh.position(v).data()) - p;
    Complex z = plane.components(chord) * std::conj(u);
    if (std::abs(z) > 0.1 * chord.norm()) z *= chord.norm() / std::abs(z);
    z *= graph.length_unit();
    // From the plane of the face to the vertex: turn^-1 w, or turn^-1 conj(w) where the corner is mirrored.
    auto carried = [&](Complex w) {
      return std::conj(frames.turn[corner]) * (mesh.mirrored(static_cast<Offset>(corner)) ? std::conj(w) : w);
    };
    const Complex x = carried(u), y = carried(u * Complex(0, 1));
    source.add(Vertex(v), stored_weights[c], std::array{z.real(), z.imag()},
               std::array{x.real(), y.real(), x.imag(), y.imag()});
  }
  return source;
}

PolygonMeshGraph::PolygonMeshGraph(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}
PolygonMeshGraph::~PolygonMeshGraph() = default;
PolygonMeshGraph::PolygonMeshGraph(PolygonMeshGraph&&) noexcept = default;
PolygonMeshGraph& PolygonMeshGraph::operator=(PolygonMeshGraph&&) noexcept = default;

const CsrGraph& PolygonMeshGraph::graph() const& noexcept { return impl_->graph; }
const PolygonReport& PolygonMeshGraph::report() const noexcept { return impl_->report; }
const PolygonMesh& PolygonMeshGraph::mesh() const noexcept { return impl_->mesh; }

PolygonMeshGraph PolygonMeshGraph::build(PolygonMesh mesh, const PolygonOptions& options, double seconds_checks) {
  PolygonReport report;
  report.seconds_checks = seconds_checks;
  report.topology = mesh.report();
  report.vertices = mesh.vertex_count();
  detail::Stopwatch stopwatch;
  options.progress.step("graph", 0.0);
  if (options.progress.stop.stop_requested()) throw Cancelled("cancelled while building the graph of a polygon mesh");
  Frames frames = find_frames(mesh, options.threads);
  CsrGraphData data = polygon_edges(mesh, frames, options, report);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    data.frames.push_back(frame_in_space(frames.vertex[v], mesh.original_position(v)));
  add_warnings(report, options.clamp_weights);
  report.seconds_graph = stopwatch.lap();
  options.progress.step("graph", 1.0);
  return PolygonMeshGraph(std::make_unique<const Impl>(
      Impl{std::move(mesh), std::move(frames), CsrGraph(std::move(data)), std::move(report)}));
}

PolygonMeshGraph PolygonMeshGraph::build(PolygonMesh mesh, const PolygonOptions& options) {
  return detail::with_memory_check("building the graph of a polygon mesh",
                                   [&] { return build(std::move(mesh), options, 0.0); });
}

PolygonMeshGraph PolygonMeshGraph::build(std::span<const Vec3> positions, std::span<const Offset> face_begin,
                                         std::span<const Index> face_vertices, const PolygonOptions& options) {
  return detail::with_memory_check("building the graph of a polygon mesh", [&] {
    detail::Stopwatch stopwatch;
    options.progress.step("checks", 0.0);
    PolygonMesh mesh = PolygonMesh::from_faces(positions, face_begin, face_vertices, options.non_manifold);
    return build(std::move(mesh), options, stopwatch.lap());
  });
}

Vertex PolygonMeshGraph::vertex(Index input_vertex) const {
  const auto map = impl_->mesh.vertex_of_input();
  if (input_vertex < 0 || static_cast<std::size_t>(input_vertex) >= map.size())
    throw InvalidArgument("source vertex " + std::to_string(input_vertex) + " is outside [0, " +
                          std::to_string(map.size()) + ")");
  if (map[input_vertex] < 0)
    throw InvalidArgument("source vertex " + std::to_string(input_vertex) + " is used by no face; choose another");
  return Vertex(map[input_vertex]);
}

Source PolygonMeshGraph::source_at_vertex(Index input_vertex) const { return Source::at_vertex(vertex(input_vertex)); }

Source PolygonMeshGraph::source_at_vertex(Index input_vertex, const Vec3& u_direction) const {
  const Vertex v = vertex(input_vertex);
  const Complex u =
      direction_in(impl_->frames.vertex[v.index], u_direction, "at vertex " + std::to_string(input_vertex));
  return Source::at_vertex(v, std::array{u.real(), u.imag()});
}

Source PolygonMeshGraph::source_at_face(Index face, std::span<const double> weights) const {
  const std::vector<double> stored = impl_->checked_weights(face, weights);
  return impl_->source(face, stored, impl_->first_side(face));
}

Source PolygonMeshGraph::source_at_face(Index face, std::span<const double> weights, const Vec3& u_direction) const {
  const std::vector<double> stored = impl_->checked_weights(face, weights);
  return impl_->source(face, stored,
                       direction_in(impl_->frames.face[face], u_direction, "in face " + std::to_string(face)));
}

Source PolygonMeshGraph::source_at_face(Index face) const {
  const std::size_t m = face >= 0 && face < impl_->mesh.face_count() ? impl_->mesh.face(face).size() : 0;
  return source_at_face(face, std::vector<double>(m, 1.0 / static_cast<double>(std::max<std::size_t>(m, 1))));
}

Frame PolygonMeshGraph::frame_at_face(Index face, std::span<const double> weights) const {
  const std::vector<double> stored = impl_->checked_weights(face, weights);
  Vec3 origin{0, 0, 0};
  for (std::size_t c = 0; c < stored.size(); ++c)
    for (int a = 0; a < 3; ++a) origin[a] += stored[c] * impl_->mesh.original_position(impl_->mesh.face(face)[c])[a];
  const Axes& plane = impl_->frames.face[face];
  const Complex u = impl_->first_side(face);
  const Vector3d x = u.real() * plane.x + u.imag() * plane.y;
  return frame_in_space({x, plane.normal.cross(x), plane.normal}, origin);
}

VertexMap PolygonMeshGraph::on_vertices(const LogMap& map) const {
  if (map.size() != impl_->graph.size() || map.dimension() != 2)
    throw InvalidArgument("on_vertices: the map has " + std::to_string(map.size()) +
                          " vertices, this mesh's graph has " + std::to_string(impl_->graph.size()) +
                          ": it belongs to another graph");
  const auto n = impl_->mesh.vertex_of_input().size();
  const std::vector<double> none(n, nan);
  VertexMap result{none, none, none, none, std::vector<Status>(n, Status::removed)};
  for (Index v = 0; v < impl_->graph.size(); ++v) {
    const Index i = impl_->mesh.input_of_vertex()[v];
    const Status status = map.status(Vertex(v));
    if (status != Status::ok) {
      if (result.status[i] != Status::ok) result.status[i] = status;
      continue;
    }
    const double distance = map.distance(Vertex(v));
    if (result.status[i] == Status::ok && result.distance[i] <= distance) continue;  // another copy is nearer
    result.u[i] = map.coordinates(Vertex(v))[0];
    result.v[i] = map.coordinates(Vertex(v))[1];
    result.distance[i] = distance;
    result.angle[i] = std::atan2(result.v[i], result.u[i]);
    result.status[i] = Status::ok;
  }
  return result;
}

}  // namespace ahm::polymesh
