#include "experiments/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ahm/conformance/closed_forms.hpp"
#include "ahm/error.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/shortest_paths.hpp"

namespace ahm::bench {

namespace {

trimesh::TriangleMeshSurface build(const Mesh& mesh, trimesh::MeshOptions options) {
  options.non_manifold = trimesh::NonManifold::split;
  return trimesh::TriangleMeshSurface::build(mesh.positions, mesh.faces, options);
}

}  // namespace

Surface::Surface(std::string name, const Mesh& mesh, trimesh::MeshOptions options)
    : name_(std::move(name)), surface_(build(mesh, std::move(options))) {
  const trimesh::TriangleMesh& checked = surface_.mesh();
  for (Index i = 0; i < checked.vertex_count(); ++i) points_.push_back(checked.original_position(Vertex(i)));
  const std::span<const Index> tails = checked.tails();
  for (std::size_t h = 0; h < tails.size(); h += 3) faces_.push_back({tails[h], tails[h + 1], tails[h + 2]});
}

std::vector<double> Surface::plane_log(Index source) const {
  const Frame frame = *graph().frame(source);
  std::vector<double> result;
  for (const Vec3& q : points_) {
    const Vec3 offset = test::minus(q, frame.origin);
    result.push_back(dot(frame.x, offset));
    result.push_back(dot(frame.y, offset));
  }
  return result;
}

std::vector<double> Surface::sphere_log(Index source) const {
  const Frame frame = *graph().frame(source);
  const Vec3& p = points_[source];
  std::vector<double> result;
  for (const Vec3& q : points_) {
    const Vec2 exact = test::sphere_log(p, frame.x, frame.y, q);
    result.insert(result.end(), exact.begin(), exact.end());
  }
  return result;
}

std::vector<double> Surface::path_lengths(Index source) const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  std::vector<double> length(points_.size(), unknown);
  ShortestPaths paths(length, unknown);
  paths.offer(source, 0);
  paths.run([&](Index i, double here) {
    const Star star = graph().star(i);
    for (std::size_t e = 0; e < star.degree(); ++e)
      paths.offer(star.neighbors[e], here + graph().length_unit() * std::hypot(star.log(e)[0], star.log(e)[1]));
  });
  return length;
}

exact::PolyhedralSurface Surface::polyhedron() const {
  const trimesh::TriangleMesh& mesh = surface_.mesh();
  std::vector<exact::FaceSides> sides;
  for (Index f = 0; f < mesh.face_count(); ++f) sides.push_back(mesh.layout(f));
  return {mesh.topology().half_edges(), sides, mesh.corners()};
}

Index Surface::nearest(const Vec3& point) const {
  auto squared = [&](const Vec3& q) {
    const Vec3 off{q[0] - point[0], q[1] - point[1], q[2] - point[2]};
    return dot(off, off);
  };
  const auto best = std::ranges::min_element(points_, {}, squared);
  return static_cast<Index>(best - points_.begin());
}

void for_user_surfaces(const Settings& settings, Index largest, const std::function<void(const Surface&)>& use) {
  for (const NamedMesh& mesh : user_meshes(settings, largest))
    run_or_leave_out(mesh.name, [&] { use(Surface(mesh.name, mesh)); });
}

std::span<const NamedMethod> log_map_methods() {
  static constexpr NamedMethod list[] = {
      {"AHM_a", [](const TangentGraph& graph) { return methods::affine_heat(graph, Variant::adaptive); }},
      {"AHM_l", [](const TangentGraph& graph) { return methods::affine_heat(graph, Variant::localized); }},
      {"VHM_log", [](const TangentGraph& graph) { return methods::vector_heat_log(graph); }},
      {"SEM", [](const TangentGraph& graph) { return methods::smoothed_exponential(graph); }},
      {"DEM",
       [](const TangentGraph& graph) {
         return methods::discrete_exponential(graph, {.turn = methods::FrameTurn::in_space});
       }},
  };
  return list;
}

Errors errors(std::span<const double> coordinates, std::span<const double> exact, const Choice& chosen) {
  Errors e;
  for (std::size_t i = 0; 2 * i < exact.size(); ++i) {
    if (!chosen(i)) continue;
    const double off = std::hypot(coordinates[2 * i] - exact[2 * i], coordinates[2 * i + 1] - exact[2 * i + 1]);
    if (!std::isfinite(off)) {
      ++e.missing;
      continue;
    }
    e.rms += off * off;
    e.mean += off;
    e.largest = std::max(e.largest, off);
    ++e.count;
  }
  if (e.count > 0) e.rms = std::sqrt(e.rms / e.count), e.mean /= e.count;
  return e;
}

double distance_rms(std::span<const double> found, std::span<const double> exact, double within) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (exact[i] <= within && std::isfinite(found[i])) sum += std::pow(found[i] - exact[i], 2), count += 1;
  return std::sqrt(sum / count);
}

std::vector<int> rings(std::span<const double> lengths, int count) {
  double longest = 0;
  for (double x : lengths)
    if (std::isfinite(x)) longest = std::max(longest, x);
  std::vector<int> result;
  for (double x : lengths)
    result.push_back(std::isfinite(x) ? std::min(count - 1, static_cast<int>(count * x / longest)) : -1);
  return result;
}

Cell known(double number) { return std::isfinite(number) ? Cell(number) : Cell(); }

double quantile(std::vector<double> values, double q) {
  return detail::value_at(values, static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> lengths(std::span<const double> coordinates) {
  std::vector<double> result;
  for (std::size_t i = 0; i < coordinates.size(); i += 2)
    result.push_back(std::hypot(coordinates[i], coordinates[i + 1]));
  return result;
}

std::vector<double> vector_errors(const Surface& surface, const LogMap& exact, const LogMap& map) {
  std::vector<double> errors;
  for (Index i = 0; i < surface.size(); ++i) {
    const Vertex v(i);
    if (map.status(v) != Status::ok || !(exact.distance(v) > 2 * surface.mean_edge())) continue;
    const auto a = exact.coordinates(v), b = map.coordinates(v);
    errors.push_back(std::hypot(a[0] - b[0], a[1] - b[1]) / exact.distance(v));
  }
  return errors;
}

std::vector<double> relative_errors(std::span<const std::complex<double>> found,
                                    std::span<const std::complex<double>> exact) {
  constexpr double near = 0.3;  // share of the vectors by which the axes are fitted
  std::vector<double> result;
  for (const auto& z : exact) result.push_back(std::abs(z));
  const double farthest = result.empty() ? 0 : quantile(result, near);
  std::complex<double> turn = 0, mirrored_turn = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    if (!(result[k] <= farthest)) continue;
    turn += found[k] * std::conj(exact[k]);
    mirrored_turn += found[k] * exact[k];
  }
  const bool is_mirrored = std::abs(mirrored_turn) > std::abs(turn);
  if (is_mirrored) turn = mirrored_turn;
  turn /= std::abs(turn);
  for (std::size_t k = 0; k < exact.size(); ++k)
    result[k] = std::abs(found[k] - turn * (is_mirrored ? std::conj(exact[k]) : exact[k])) / result[k];
  return result;
}

std::string vector_error_summary(const Table& table) {
  const auto median = [&](const char* as, const char* method) {
    return quantile(table.where("as", as).where("method", method).numbers("vector 95%"), 0.5);
  };
  return fmt::format(
      "95th percentile of the vectors' relative error, median over meshes: polar {:.2g} on triangles and {:.2g} on "
      "their vertices as points, heat {:.2g} and {:.2g}.",
      median("triangles", "polar"), median("points", "polar"), median("triangles", "heat"), median("points", "heat"));
}

double fitted_order(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace ahm::bench
