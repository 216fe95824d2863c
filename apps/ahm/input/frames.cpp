#include "input/frames.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/surface/directions.hpp"

namespace ahm::app {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Length of the mean of the neighbours' directions carried to the vertex, as axes (angles count twice): 1 where all are
/// parallel to each other, near 0 where they are random.
double agreement_around(const TangentGraph& graph, const PrincipalCurvatures& bend, Index vertex) {
  const Star star = graph.star(vertex);
  const bool is_block = graph.transport_kind() == TransportKind::block;
  double c = 0, s = 0, count = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) {
    const auto d = bend.direction(Vertex(star.neighbors[e]));
    if (std::isnan(d[0])) continue;
    const double* R = &star.transports[e * (is_block ? 4 : 2)];
    const double x = is_block ? R[0] * d[0] + R[1] * d[1] : R[0] * d[0] - R[1] * d[1];
    const double y = is_block ? R[2] * d[0] + R[3] * d[1] : R[1] * d[0] + R[0] * d[1];
    c += x * x - y * y, s += 2 * x * y, count += 1;
  }
  return count > 0 ? std::hypot(c, s) / count : 0;
}

}  // namespace

Frame turned(const Frame& frame, const Vec3& direction) {
  const double a = dot(direction, frame.x), b = dot(direction, frame.y);
  const double length = std::hypot(a, b);
  Frame result = frame;
  for (std::size_t c = 0; c < 3; ++c) result.x[c] = (a * frame.x[c] + b * frame.y[c]) / length;
  result.y = cross(frame.normal, result.x);
  return result;
}

Vec3 bending_direction(const TangentGraph& graph, Vertex vertex) {
  const std::optional<Frame> frame = graph.frame(vertex.index);
  if (!frame) throw InvalidArgument("--u-axis curvature: the graph has no frames in space");
  const PrincipalCurvatures bend = curvature_directions(graph);
  const auto at = [](Index i) { return 2 * static_cast<std::size_t>(i); };
  const double first = bend.values[at(vertex.index)], second = bend.values[at(vertex.index) + 1];
  const std::string advice = "; give the axis as X,Y,Z";
  if (std::isnan(first))
    throw InvalidArgument("--u-axis curvature: the source has too few neighbours to tell" + advice);
  const double edge = graph.mean_edge_length() * graph.length_unit();
  if (!(std::abs(first) * edge > 1e-6))
    throw InvalidArgument("--u-axis curvature: the surface is flat at the source" + advice);
  if (!(std::abs(first - second) > 0.1 * std::abs(first)))
    throw InvalidArgument(fmt::format(
        "--u-axis curvature: at the source the surface bends alike in all directions (curvatures {:.3g} and {:.3g}){}",
        first, second, advice));
  if (const double agreement = agreement_around(graph, bend, vertex.index); agreement < 0.5)
    throw InvalidArgument(fmt::format(
        "--u-axis curvature: the directions around the source contradict each other (agreement {:.2f} of 1), "
        "as on planes and rough scans{}",
        agreement, advice));
  const auto d = bend.direction(vertex);
  Vec3 result;
  for (std::size_t a = 0; a < 3; ++a) result[a] = d[0] * frame->x[a] + d[1] * frame->y[a];
  return result;
}

}  // namespace ahm::app
