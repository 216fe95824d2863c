#include "ahm/surface/directions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void check_dimension(const TangentGraph& graph, const char* name) {
  if (graph.dimension() != 2)
    throw InvalidArgument(std::string(name) + ": the graph has dimension " + std::to_string(graph.dimension()) +
                          ", not 2");
}

Frame frame_of(const TangentGraph& graph, Index vertex, const char* name) {
  const std::optional<Frame> frame = graph.frame(vertex);
  if (!frame)
    throw InvalidArgument(std::string(name) + ": the graph has no frame in space at vertex " + std::to_string(vertex) +
                          "; use a backend that knows positions");
  return *frame;
}

/// Neighbours of neighbours and neighbours, each once, without the vertex itself.
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

Vec3 between(const Vec3& from, const Vec3& to) { return {to[0] - from[0], to[1] - from[1], to[2] - from[2]}; }

/// The shape operator of a vertex from the heights of others over its tangent plane; NaN where these do not tell.
Eigen::Matrix2d shape_operator(const Frame& frame, std::span<const Vec3> others) {
  double reach = 0;  // the unit of length here
  for (const Vec3& p : others) reach = std::max(reach, length(between(frame.origin, p)));
  // z = t . (x, y) + (a x^2 + 2 b x y + c y^2) / 2, each row over |(x, y)|^2: normal equations in (t, a, b, c).
  using Row = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Row right = Row::Zero();
  for (const Vec3& p : others) {
    const Vec3 away = between(frame.origin, p);
    const double x = dot(away, frame.x) / reach, y = dot(away, frame.y) / reach, r = std::hypot(x, y);
    if (!(r > 0)) continue;
    const double c = x / r, s = y / r;
    const Row row{c / r, s / r, c * c / 2, c * s, s * s / 2};
    normal += row * row.transpose();
    right += row * (dot(away, frame.normal) / reach / r / r);
  }
  Eigen::FullPivLU<Eigen::Matrix<double, 5, 5>> lu(normal);
  lu.setThreshold(1e-10);
  if (!lu.isInvertible()) return Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Row fit = lu.solve(right);
  return (Eigen::Matrix2d() << fit[2], fit[3], fit[3], fit[4]).finished() / -reach;
}

}  // namespace

std::array<double, 2> direction_in_frame(const TangentGraph& graph, Vertex vertex, const Vec3& vector) {
  const char* name = "direction_in_frame";
  check_dimension(graph, name);
  if (vertex.index < 0 || vertex.index >= graph.size())
    throw InvalidArgument("direction_in_frame: 'vertex' " + std::to_string(vertex.index) + " is outside [0, " +
                          std::to_string(graph.size()) + ")");
  const Frame frame = frame_of(graph, vertex.index, name);
  const double largest = std::max({std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2])});
  if (!(largest > 0) || !all_finite(vector))
    throw InvalidArgument("direction_in_frame: 'vector' must be finite and not zero");
  const Vec3 scaled{vector[0] / largest, vector[1] / largest, vector[2] / largest};
  const double u = dot(frame.x, scaled), v = dot(frame.y, scaled), r = std::hypot(u, v);
  if (!(r > 1e-9))
    throw InvalidArgument("direction_in_frame: 'vector' is perpendicular to the surface at vertex " +
                          std::to_string(vertex.index) + "; choose another one");
  return {u / r, v / r};
}

PrincipalCurvatures curvature_directions(const TangentGraph& graph) {
  const char* name = "curvature_directions";
  check_dimension(graph, name);
  const Index n = graph.size();
  PrincipalCurvatures result{std::vector<double>(2 * static_cast<std::size_t>(n)), {}};
  result.directions.resize(result.values.size());
  detail::parallel_chunks(n, 1 << 12, 0, [&](Offset begin, Offset end) {
    std::vector<Index> first, both;
    std::vector<Vec3> others;
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      collect_two_rings(graph, i, first, both);
      others.clear();
      for (Index j : both) others.push_back(frame_of(graph, j, name).origin);
      const Eigen::Matrix2d S = shape_operator(frame_of(graph, i, name), others);
      const double mean = (S(0, 0) + S(1, 1)) / 2, half = (S(0, 0) - S(1, 1)) / 2, gap = std::hypot(half, S(0, 1));
      // S turns like a vector of twice the angle: the eigenvector of mean + gap lies at half the angle of (half, S_01).
      const double sign = mean < 0 ? -1 : 1, angle = std::atan2(sign * S(0, 1), sign * half) / 2;
      double* values = result.values.data() + 2 * static_cast<std::size_t>(i);
      double* direction = result.directions.data() + 2 * static_cast<std::size_t>(i);
      values[0] = mean + sign * gap;
      values[1] = mean - sign * gap;
      direction[0] = std::cos(angle);
      direction[1] = std::sin(angle);
    }
  });
  return result;
}

}  // namespace ahm
