#include "ahm/applications/inverse_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/surface/surface_triangles.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

/// The unit vector along `a`; zero stays zero.
Vec3 unit_or_zero(const Vec3& a) {
  const double norm = length(a);
  return norm > 0 ? Vec3{a[0] / norm, a[1] / norm, a[2] / norm} : Vec3{};
}

void check(const MappedSurface& s, const InverseMapOptions& options) {
  const std::size_t n = s.positions.size();
  const auto check_length = [&](const char* name, std::size_t size, std::size_t wanted) {
    if (size != wanted)
      throw InvalidArgument("'" + std::string(name) + "' has " + detail::counted(size, "entry") + ", not " +
                            std::to_string(wanted));
  };
  check_length("normals", s.normals.size(), n);
  check_length("coordinates", s.coordinates.size(), 2 * n);
  check_length("valid", s.valid.size(), n);
  const auto check_index = [&](const std::string& what, Index vertex) {
    if (vertex < 0 || to_size(vertex) >= n)
      throw InvalidArgument(what + " refers to vertex " + std::to_string(vertex) + ", outside [0, " +
                            std::to_string(n) + ")");
  };
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (Index vertex : s.triangles[t]) check_index("triangle " + std::to_string(t), vertex);
  for (Index vertex : s.sources) check_index("'sources'", vertex);
  if (!(options.max_stretch > 1))
    throw InvalidArgument("max_stretch is " + std::to_string(options.max_stretch) + "; it must be > 1");
}

/// Whether the triangle can be used: it has valid corners, keeps its orientation and is not stretched too much.
bool is_usable(const MappedSurface& s, const Triangle& t, double max_stretch) {
  std::array<Vec2, 3> q;
  for (std::size_t c = 0; c < 3; ++c) {
    q[c] = {s.coordinates[2 * to_size(t[c])], s.coordinates[2 * to_size(t[c]) + 1]};
    if (!s.valid[t[c]] || !all_finite(q[c]) || !all_finite(s.positions[t[c]])) return false;
  }
  std::array<double, 3> edge;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t next = (c + 1) % 3;
    edge[c] = length(q[next] - q[c]);
    const double space = length(s.positions[t[next]] - s.positions[t[c]]);
    if (!(edge[c] > 0 && edge[c] <= max_stretch * space && space <= max_stretch * edge[c])) return false;
  }
  Vec2 a = q[1] - q[0], b = q[2] - q[0];
  for (double& x : a) x /= edge[0];
  for (double& x : b) x /= edge[2];
  return cross(a, b) > 1e-12;  // sine of the angle at the first corner
}

/// Lengths of the shortest edge paths from the sources, along the triangles; infinite where there is none.
std::vector<double> graph_distances(const MappedSurface& s, const std::vector<Triangle>& triangles,
                                    const std::vector<Index>& sources) {
  const std::size_t n = s.positions.size();
  std::vector<Offset> begin(n + 1, 0);  // first triangle of each vertex in `incident`
  for (const Triangle& t : triangles)
    for (Index v : t) ++begin[to_size(v) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> incident(3 * triangles.size());
  std::vector<Offset> end(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (Index v : triangles[t]) incident[end[v]++] = static_cast<Index>(t);

  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  ShortestPaths<double, std::vector<double>> paths(distance, std::numeric_limits<double>::infinity());
  for (Index v : sources) paths.offer(v, 0);
  paths.run([&](Index i, double d) {
    for (Offset k = begin[i]; k < begin[to_size(i) + 1]; ++k)
      for (Index j : triangles[incident[k]]) paths.offer(j, d + length(s.positions[j] - s.positions[i]));
  });
  return distance;
}

/// The vertex of the triangles with the smallest |phi|.
std::vector<Index> nearest_to_origin(const MappedSurface& s, const std::vector<Triangle>& triangles) {
  std::vector<Index> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles)
    for (Index v : t)
      if (const double r = length(s.coordinates.subspan(2 * to_size(v), 2)); r < least) least = r, best = {v};
  return best;
}

/// The sources that are corners of the triangles; the vertex nearest to the origin where there are none.
std::vector<Index> start_vertices(const MappedSurface& s, const std::vector<Triangle>& triangles) {
  std::vector<bool> is_corner(s.positions.size());
  for (const Triangle& t : triangles)
    for (Index v : t) is_corner[v] = true;
  std::vector<Index> result;
  std::copy_if(s.sources.begin(), s.sources.end(), std::back_inserter(result), [&](Index v) { return is_corner[v]; });
  return result.empty() ? nearest_to_origin(s, triangles) : result;
}

/// The triangles that can be used, nearest to the source first.
std::vector<Triangle> sorted_triangles(const MappedSurface& s, double max_stretch) {
  std::vector<Triangle> usable;
  for (const Triangle& t : s.triangles)
    if (is_usable(s, t, max_stretch)) usable.push_back(t);
  const std::vector<double> distance = graph_distances(s, usable, start_vertices(s, usable));
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t t = 0; t < usable.size(); ++t) {
    const auto [a, b, c] = usable[t];
    order.push_back({distance[a] + distance[b] + distance[c], t});
  }
  std::sort(order.begin(), order.end());
  std::vector<Triangle> result;
  for (const auto& [d, t] : order) result.push_back(usable[t]);
  return result;
}

}  // namespace

Frame InversePoint::frame() const {
  const double along = dot(du, normal);
  Vec3 x = unit_or_zero({du[0] - along * normal[0], du[1] - along * normal[1], du[2] - along * normal[2]});
  if (x == Vec3{}) x = unit_or_zero(cross(dv, normal));  // du is parallel to the normal
  return {position, x, cross(normal, x), normal};
}

InverseMap::InverseMap(const MappedSurface& surface, const InverseMapOptions& options)
    : max_stretch_(options.max_stretch), origin_(surface.origin) {
  check(surface, options);
  triangles_ = sorted_triangles(surface, max_stretch_);
  positions_.assign(surface.positions.begin(), surface.positions.end());
  normals_.assign(surface.normals.begin(), surface.normals.end());
  double largest = 0;
  for (const Triangle& t : triangles_)
    for (Index v : t)
      for (std::size_t c : {0, 1}) largest = std::max(largest, std::abs(surface.coordinates[2 * to_size(v) + c]));
  unit_ = power_of_two_below(largest);
  for (std::size_t v = 0; v < positions_.size(); ++v)
    plane_.push_back({surface.coordinates[2 * v] / unit_, surface.coordinates[2 * v + 1] / unit_});
  make_buckets();
}

Index InverseMap::bucket(std::size_t axis, double x) const {
  return static_cast<Index>(std::clamp(std::floor((x - low_[axis]) / side_), 0.0, buckets_[axis] - 1.0));
}

/// Square buckets, about as many as triangles. Each lists the triangles whose bounding box touches it, nearest to the
/// source first.
void InverseMap::make_buckets() {
  if (triangles_.empty()) return;
  low_ = high_ = plane_[triangles_[0][0]];
  for (const Triangle& t : triangles_)
    for (Index v : t)
      for (std::size_t c : {0, 1}) {
        low_[c] = std::min(low_[c], plane_[v][c]);
        high_[c] = std::max(high_[c], plane_[v][c]);
      }
  const double width = high_[0] - low_[0], height = high_[1] - low_[1];
  const auto count = static_cast<double>(triangles_.size());
  side_ = std::max(std::sqrt(width * height / count), std::max(width, height) / count);
  buckets_ = {static_cast<Index>(width / side_) + 1, static_cast<Index>(height / side_) + 1};
  const auto for_buckets = [&](const Triangle& t, const auto& visit) {
    std::array<Index, 2> first, last;
    for (std::size_t c : {0, 1}) {
      const auto [least, most] = std::minmax({plane_[t[0]][c], plane_[t[1]][c], plane_[t[2]][c]});
      first[c] = bucket(c, least - 1e-9 * side_), last[c] = bucket(c, most + 1e-9 * side_);
    }
    for (Index y = first[1]; y <= last[1]; ++y)
      for (Index x = first[0]; x <= last[0]; ++x) visit(to_size(y) * to_size(buckets_[0]) + to_size(x));
  };
  bucket_begin_.assign(to_size(buckets_[0]) * to_size(buckets_[1]) + 1, 0);
  for (const Triangle& t : triangles_) for_buckets(t, [&](std::size_t b) { ++bucket_begin_[b + 1]; });
  std::partial_sum(bucket_begin_.begin(), bucket_begin_.end(), bucket_begin_.begin());
  bucket_triangles_.resize(static_cast<std::size_t>(bucket_begin_.back()));
  std::vector<Offset> end(bucket_begin_.begin(), bucket_begin_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for_buckets(triangles_[t], [&](std::size_t b) { bucket_triangles_[end[b]++] = static_cast<Index>(t); });
}

std::array<Vec2, 3> InverseMap::corners(const Triangle& triangle) const {
  std::array<Vec2, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = {plane_[triangle[k]][0] * unit_, plane_[triangle[k]][1] * unit_};
  return result;
}

std::optional<InversePoint> InverseMap::at(double u, double v) const {
  const Vec2 q{u / unit_, v / unit_};
  const std::optional<InversePoint> found = in_triangles(q);
  if (!origin_ || q != Vec2{0, 0}) return found;
  // If the triangles at the source are left out, a triangle of another sheet may cover (0, 0).
  return found && distance(found->position, origin_->position) <= 1e-9 * unit_ ? found : origin_;
}

std::optional<InversePoint> InverseMap::in_triangles(const Vec2& q) const {
  if (triangles_.empty() || !all_finite(q)) return std::nullopt;
  const std::size_t b = to_size(bucket(1, q[1])) * to_size(buckets_[0]) + to_size(bucket(0, q[0]));
  for (Offset k = bucket_begin_[b]; k < bucket_begin_[b + 1]; ++k)
    if (auto point = in_triangle(triangles_[bucket_triangles_[k]], q)) return point;
  return std::nullopt;
}

std::optional<InversePoint> InverseMap::in_triangle(const Triangle& t, const Vec2& q) const {
  const std::array<std::size_t, 3> corner{to_size(t[0]), to_size(t[1]), to_size(t[2])};
  const Vec2 a = plane_[corner[1]] - plane_[corner[0]], b = plane_[corner[2]] - plane_[corner[0]],
             r = q - plane_[corner[0]];
  const double area = cross(a, b);
  InversePoint point;
  point.vertices = t;
  point.weights = {0, cross(r, b) / area, cross(a, r) / area};
  point.weights[0] = 1 - point.weights[1] - point.weights[2];
  // The tolerance closes the gaps that rounding leaves between triangles.
  if (!(std::min({point.weights[0], point.weights[1], point.weights[2]}) >= -1e-10)) return std::nullopt;
  Vec3 ea = positions_[corner[1]] - positions_[corner[0]], eb = positions_[corner[2]] - positions_[corner[0]];
  for (std::size_t k = 0; k < 3; ++k) {
    point.position[k] = positions_[corner[0]][k] + (point.weights[1] * ea[k] + point.weights[2] * eb[k]);
    ea[k] /= unit_, eb[k] /= unit_;
    point.du[k] = (ea[k] * b[1] - eb[k] * a[1]) / area;
    point.dv[k] = (eb[k] * a[0] - ea[k] * b[0]) / area;
    point.normal[k] = 0;
    for (std::size_t c = 0; c < 3; ++c) point.normal[k] += point.weights[c] * normals_[corner[c]][k];
  }
  point.normal = unit_or_zero(point.normal);
  return point;
}

namespace {

/// The quality of each vertex; empty if no minimum is required. @throws InvalidArgument (a quality of other vertices)
std::vector<double> required_quality(const TangentGraph& graph, const LogMap& map, const InverseMapOptions& options) {
  if (!(options.min_quality > 0)) return {};
  if (options.quality.empty()) return map_quality(graph, map, options.threads);
  if (options.quality.size() != static_cast<std::size_t>(graph.size()))
    throw InvalidArgument("the quality has " + detail::counted(options.quality.size(), "entry") + " for " +
                          detail::counted(graph.size(), "vertex"));
  return {options.quality.begin(), options.quality.end()};
}

/// The source as a point of the surface, if it is one point between at most three vertices that have an index in the arrays
/// of `s`.
/// @param number  number(vertex): that index, or none
template <class Number>
std::optional<InversePoint> origin_of(const TangentGraph& graph, const Source& source, const MappedSurface& s,
                                      const Number& number) {
  const std::size_t samples = source.vertices().size();
  if (source.is_curve() || samples < 1 || samples > 3) return std::nullopt;
  InversePoint point{};
  double weights = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t sample = std::min(k, samples - 1);
    const std::optional<Index> at = number(source.vertices()[sample]);
    if (!at || source.place(sample).point != 0) return std::nullopt;
    point.vertices[k] = *at;
    point.weights[k] = k < samples ? source.weights()[k] : 0;
    weights += point.weights[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    point.weights[k] /= weights;
    point.position = point.position + point.weights[k] * s.positions[point.vertices[k]];
    point.normal = point.normal + point.weights[k] * s.normals[point.vertices[k]];
  }
  point.normal = unit_or_zero(point.normal);
  const Vec2 u = u_axis_at_point(source);
  const Frame frame = *graph.frame(tangent_plane_point(source).vertex.index);
  const Vec3 axis = u[0] * frame.x + u[1] * frame.y;
  point.du = unit_or_zero(axis - dot(axis, point.normal) * point.normal);
  point.dv = cross(point.normal, point.du);
  return point;
}

}  // namespace

InverseMap inverse_map(const TangentGraph& graph, const LogMap& map, const InverseMapOptions& options) {
  const std::vector<Vec3> normals = source_side_normals(graph, map);
  const std::vector<Triangle> triangles = star_triangles(graph, map);
  const std::size_t n = normals.size();
  std::vector<Vec3> positions(n);
  std::vector<std::uint8_t> valid(n);
  const std::vector<double> quality = required_quality(graph, map, options);
  for (Index i = 0; i < graph.size(); ++i) {
    if (map.status(Vertex(i)) != Status::ok) continue;
    positions[i] = graph.frame(i)->origin;
    valid[i] = quality.empty() || quality[i] >= options.min_quality;
  }
  std::vector<Index> sources;
  for (Vertex vertex : map.source().vertices()) sources.push_back(vertex.index);
  MappedSurface mapped{positions, normals, map.coordinates(), valid, triangles, sources};
  mapped.origin =
      origin_of(graph, map.source(), mapped, [](Vertex vertex) { return std::optional<Index>(vertex.index); });
  return InverseMap(mapped, options);
}

InverseMap inverse_map(const Surface& surface, const LogMap& map, const InverseMapOptions& options) {
  const TangentGraph& graph = surface.graph();
  const std::vector<Vec3> graph_normals = source_side_normals(graph, map);
  const RowLogMap rows = surface.to_rows(map);
  const std::size_t n = rows.vertex.size();
  const std::vector<double> quality = required_quality(graph, map, options);
  std::vector<Vec3> normals(n);
  std::vector<double> coordinates(2 * n);
  std::vector<std::uint8_t> valid(n);
  for (std::size_t r = 0; r < n; ++r) {
    if (!rows.vertex[r]) continue;
    const Index v = rows.vertex[r]->index;
    normals[r] = graph_normals[v];
    coordinates[2 * r] = rows.u[r], coordinates[2 * r + 1] = rows.v[r];
    valid[r] = quality.empty() || quality[v] >= options.min_quality;
  }
  const auto row = [&](Index vertex) { return surface.rows().row(Vertex(vertex)); };
  MappedSurface mapped{surface.positions(), normals, coordinates, valid, {}};
  mapped.origin = origin_of(graph, map.source(), mapped, [&](Vertex vertex) {
    const auto at = row(vertex.index);
    return at ? std::optional<Index>(at->index) : std::nullopt;
  });
  if (surface.faces().size() > 0) {
    const std::vector<Triangle> turned = turned_triangles(surface, normals);
    mapped.triangles = turned;
    return InverseMap(mapped, options);
  }
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : star_triangles(graph, map))
    if (row(a) && row(b) && row(c)) triangles.push_back({row(a)->index, row(b)->index, row(c)->index});
  std::vector<Index> sources;
  for (Vertex v : map.source().vertices())
    if (row(v.index)) sources.push_back(row(v.index)->index);
  mapped.triangles = triangles;
  mapped.sources = sources;
  return InverseMap(mapped, options);
}

}  // namespace ahm
