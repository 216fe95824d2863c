#include "directions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"

namespace ahm {

void Paraboloid::add(const Vec2& x, double z, double weight) {
  const double u = x[0] / unit_, v = x[1] / unit_;
  const std::array<double, 5> row{u, v, -u * u / 2, -u * v, -v * v / 2};
  for (std::size_t a = 0; a < 5; ++a) {
    for (std::size_t b = 0; b < 5; ++b) normal_[5 * a + b] += weight * row[a] * row[b];
    right_[a] += weight * row[a] * (z / unit_);
  }
}

PrincipalCurvature Paraboloid::curvature() const {
  Eigen::FullPivLU<Eigen::Matrix<double, 5, 5>> lu(Eigen::Map<const Eigen::Matrix<double, 5, 5>>(normal_.data()));
  lu.setThreshold(1e-10);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!lu.isInvertible()) return {{unknown, unknown}, {unknown, unknown}};
  const Eigen::Matrix<double, 5, 1> fit = lu.solve(Eigen::Map<const Eigen::Matrix<double, 5, 1>>(right_.data()));
  const double mean = (fit[2] + fit[4]) / 2, half = (fit[2] - fit[4]) / 2, gap = std::hypot(half, fit[3]);
  // S rotates like a vector of twice the angle: the eigenvector of mean + gap is at half the angle of (half, S_01).
  const double sign = mean < 0 ? -1 : 1, angle = std::atan2(sign * fit[3], sign * half) / 2;
  return {{(mean + sign * gap) / unit_, (mean - sign * gap) / unit_}, {std::cos(angle), std::sin(angle)}};
}

namespace {

void check_dimension(const TangentGraph& graph, const char* name) {
  if (graph.dimension() != 2)
    throw InvalidArgument(std::string(name) + ": the graph has dimension " + std::to_string(graph.dimension()) +
                          ", not 2");
}

Frame frame_of(const TangentGraph& graph, Index vertex, const char* name) {
  const std::optional<Frame> frame = graph.frame(vertex);
  if (!frame)
    throw InvalidArgument(std::string(name) + ": the graph has no frame in space at vertex " + std::to_string(vertex) +
                          "; use a backend that provides positions");
  return *frame;
}

/// Neighbors and neighbors of neighbors, each once, without the vertex itself.
void collect_two_rings(const TangentGraph& graph, Index vertex, std::vector<Index>& first, std::vector<Index>& both) {
  const auto neighbors = graph.star(vertex).neighbors;
  first.assign(neighbors.begin(), neighbors.end());
  both = first;
  for (Index j : first) {
    const auto next = graph.star(j).neighbors;
    both.insert(both.end(), next.begin(), next.end());
  }
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end()), both.end());
  std::erase(both, vertex);
}

/// Curvature at a vertex, from the heights of other points over its tangent plane.
PrincipalCurvature curvature_by(const Frame& frame, std::span<const Vec3> others) {
  double reach = 0;
  for (const Vec3& p : others) reach = std::max(reach, length(p - frame.origin));
  Paraboloid fit(reach);
  for (const Vec3& p : others) {
    const Vec3 away = p - frame.origin;
    const Vec2 x{dot(away, frame.x), dot(away, frame.y)};
    const double share = length(x) / reach;
    if (share > 0) fit.add(x, dot(away, frame.normal), std::pow(share, -4));
  }
  return fit.curvature();
}

/// Length of the mean of the neighbors' directions, transported to the vertex and treated as axes (angles doubled). 1 where all
/// are parallel to each other, near 0 where they are random.
double direction_agreement(const TangentGraph& graph, const PrincipalCurvatures& bend, Index vertex) {
  const Star star = graph.star(vertex);
  double c = 0, s = 0, count = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const auto d = bend.direction(Vertex(star.neighbors[e]));
    if (std::isnan(d[0])) continue;
    Vec2 v{};
    star.transport(e).apply(d.data(), v.data());
    c += v[0] * v[0] - v[1] * v[1], s += 2 * v[0] * v[1], count += 1;
  }
  return count > 0 ? std::hypot(c, s) / count : 0;
}

/// Formats a number with a few digits, for messages.
std::string format_value(const char* format, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

}  // namespace

Vec2 projected(const Vec3& x, const Vec3& y, const Vec3& vector, const std::string& where) {
  if (!(largest(vector) > 0) || !is_finite(vector))
    throw InvalidArgument("a direction " + where + " must be finite and not zero");
  const Vec3 scaled = 1 / power_of_two_below(largest(vector)) * vector;
  const Vec2 result{dot(x, scaled), dot(y, scaled)};
  if (!(length(result) > 1e-9))
    throw InvalidArgument("axis_along_normal", "a direction is perpendicular to the surface " + where,
                          "choose another one");
  return result;
}

void check_off_normal(const Vec3& direction, const Vec3& normal, double error, const std::string& where) {
  if (!(largest(direction) > 0) || !is_finite(direction))
    throw InvalidArgument("a direction " + where + " must be finite and not zero");
  const Vec3 scaled = 1 / power_of_two_below(largest(direction)) * direction;
  const double off = std::atan2(length(cross(scaled, normal)), std::abs(dot(scaled, normal))) * 180 / std::numbers::pi;
  if (!(off >= error))
    throw InvalidArgument("axis_along_normal",
                          "the direction is " + format_value("%.2g", off) + " degrees from the normal " + where +
                              "; the error of the normal in degrees is up to " + format_value("%.2g", error),
                          "choose another one");
}

Vec2 projected(const TangentGraph& graph, Vertex vertex, const Vec3& vector) {
  const char* name = "direction_in_frame";
  check_dimension(graph, name);
  if (vertex.index < 0 || vertex.index >= graph.size())
    throw InvalidArgument("direction_in_frame: 'vertex' " + std::to_string(vertex.index) + " is outside [0, " +
                          std::to_string(graph.size()) + ")");
  const Frame frame = frame_of(graph, vertex.index, name);
  return projected(frame.x, frame.y, vector, "at vertex " + std::to_string(vertex.index));
}

Vec2 direction_in_frame(const TangentGraph& graph, Vertex vertex, const Vec3& vector) {
  const Vec2 p = projected(graph, vertex, vector);
  check_off_normal(vector, frame_of(graph, vertex.index, "direction_in_frame").normal, normal_error,
                   "at vertex " + std::to_string(vertex.index));
  const double r = length(p);
  return {p[0] / r, p[1] / r};
}

Frame turned(const Frame& frame, const Vec3& direction) {
  const double a = dot(direction, frame.x), b = dot(direction, frame.y);
  const double r = std::hypot(a, b);
  Frame result = frame;
  for (std::size_t c = 0; c < 3; ++c) result.x[c] = (a * frame.x[c] + b * frame.y[c]) / r;
  result.y = cross(frame.normal, result.x);
  return result;
}

PrincipalCurvatures curvature_directions(const TangentGraph& graph, unsigned threads) {
  const char* name = "curvature_directions";
  check_dimension(graph, name);
  const Index n = graph.size();
  PrincipalCurvatures result{std::vector<double>(2 * static_cast<std::size_t>(n)), {}};
  result.directions.resize(result.values.size());
  detail::parallel_chunks(n, 1 << 12, threads, [&](Offset begin, Offset end) {
    std::vector<Index> first, both;
    std::vector<Vec3> others;
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      collect_two_rings(graph, i, first, both);
      others.clear();
      for (Index j : both) others.push_back(frame_of(graph, j, name).origin);
      const auto [values, direction] = curvature_by(frame_of(graph, i, name), others);
      std::copy_n(values.begin(), 2, result.values.begin() + 2 * static_cast<std::ptrdiff_t>(i));
      std::copy_n(direction.begin(), 2, result.directions.begin() + 2 * static_cast<std::ptrdiff_t>(i));
    }
  });
  return result;
}

Vec3 bending_direction(const TangentGraph& graph, Vertex vertex, unsigned threads) {
  const Frame frame = frame_of(graph, vertex.index, "bending_direction");
  const PrincipalCurvatures bend = curvature_directions(graph, threads);
  const double first = bend.values[2 * static_cast<std::size_t>(vertex.index)],
               second = bend.values[2 * static_cast<std::size_t>(vertex.index) + 1];
  const auto refuse = [](const std::string& problem) {
    throw InvalidArgument("no_bending_direction", problem, "give a direction");
  };
  if (std::isnan(first)) refuse("the source has too few neighbors to fit a curvature");
  const double edge = graph.mean_edge_length() * graph.length_unit();
  if (!(std::abs(first) * edge > 1e-6)) refuse("the surface is flat at the source");
  if (!(std::abs(first - second) > 0.1 * std::abs(first)))
    refuse("at the source the surface bends equally in all directions (curvatures " + format_value("%.3g", first) +
           " and " + format_value("%.3g", second) + ")");
  if (const double agreement = direction_agreement(graph, bend, vertex.index); agreement < 0.5)
    refuse("the directions around the source contradict each other (agreement " + format_value("%.2f", agreement) +
           " of 1), as on planes and rough scans");
  const auto d = bend.direction(vertex);
  return d[0] * frame.x + d[1] * frame.y;
}

}  // namespace ahm
