#include "ahm/applications/mean.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "ahm/error.hpp"
#include "ahm/maps/tangent_lines.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "surface_curve.hpp"

namespace ahm {

/// Points as K x d coordinates with K weights > 0.
struct FlatPoints {
  std::size_t dimension = 0;
  std::vector<double> coordinates;
  std::vector<double> weights;

  std::size_t size() const { return weights.size(); }
  std::span<const double> operator[](std::size_t k) const {
    return std::span(coordinates).subspan(k * dimension, dimension);
  }
};

/// The weighted mean: sum w z / sum w.
std::vector<double> flat_mean(const FlatPoints& points);

/// A minimum of sum w |z - x| over x, to rounding.
std::vector<double> flat_median(const FlatPoints& points);

/// Distances of the points from x, one per point.
std::vector<double> distances(const FlatPoints& points, std::span<const double> x);

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

Eigen::Map<const VectorXd> point(const FlatPoints& points, std::size_t k) {
  return {points[k].data(), static_cast<Eigen::Index>(points.dimension)};
}

double sum_of_distances(const FlatPoints& points, const VectorXd& x) {
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) sum += points.weights[k] * (point(points, k) - x).norm();
  return sum;
}

/// Derivatives of F(x) = sum w |z - x|. Points at x itself contribute to `weight` only.
struct SumDerivatives {
  VectorXd pull;      ///< sum w u, with the unit vectors u towards the points: -grad F
  MatrixXd hessian;   ///< sum w / |z - x| (id - u u^T)
  double rate = 0;    ///< sum w / |z - x|, an upper bound of the eigenvalues of the Hessian
  double weight = 0;  ///< weight of the points at x

  /// x is a minimum if the pull of the other points is at most the weight of the points at x (Vardi & Zhang 2000).
  bool is_minimum() const { return pull.norm() <= weight; }
};

SumDerivatives derivatives_at(const FlatPoints& points, const VectorXd& x) {
  const Eigen::Index d = x.size();
  SumDerivatives derivatives{VectorXd::Zero(d), MatrixXd::Zero(d, d)};
  VectorXd u(d);
  for (std::size_t k = 0; k < points.size(); ++k) {
    u = point(points, k) - x;
    const double r = u.norm(), w = points.weights[k];
    if (r == 0) {
      derivatives.weight += w;
      continue;
    }
    u /= r;
    derivatives.pull += w * u;
    derivatives.rate += w / r;
    derivatives.hessian.diagonal().array() += w / r;
    derivatives.hessian.noalias() -= w / r * u * u.transpose();
  }
  return derivatives;
}

/// The better of Newton's and Weiszfeld's step. Weiszfeld's always descends, also at points [VZ00]. Newton's may be worse
/// by rounding.
VectorXd step(const FlatPoints& points, const VectorXd& x, const SumDerivatives& derivatives) {
  VectorXd weiszfeld = (1 - derivatives.weight / derivatives.pull.norm()) / derivatives.rate * derivatives.pull;
  if (derivatives.weight > 0) return weiszfeld;
  const VectorXd newton = derivatives.hessian.ldlt().solve(derivatives.pull);
  if (!newton.allFinite()) return weiszfeld;
  const double by_newton = sum_of_distances(points, x + newton), by_weiszfeld = sum_of_distances(points, x + weiszfeld);
  return by_newton <= by_weiszfeld * (1 + 1e-13) ? newton : weiszfeld;
}

VectorXd nearest_point(const FlatPoints& points, const VectorXd& x) {
  const std::vector<double> away = distances(points, {x.data(), static_cast<std::size_t>(x.size())});
  return point(points, static_cast<std::size_t>(std::min_element(away.begin(), away.end()) - away.begin()));
}

}  // namespace

std::vector<double> distances(const FlatPoints& points, std::span<const double> x) {
  const Eigen::Map<const VectorXd> at(x.data(), static_cast<Eigen::Index>(x.size()));
  std::vector<double> away(points.size());
  for (std::size_t k = 0; k < away.size(); ++k) away[k] = (point(points, k) - at).norm();
  return away;
}

std::vector<double> flat_mean(const FlatPoints& points) {
  const double total = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  std::vector<double> mean(points.dimension, 0.0);
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t a = 0; a < mean.size(); ++a) mean[a] += points.weights[k] / total * points[k][a];
  return mean;
}

std::vector<double> flat_median(const FlatPoints& points) {
  const std::vector<double> mean = flat_mean(points);
  VectorXd x = Eigen::Map<const VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()));
  const std::vector<double> away = distances(points, mean);
  const double size = *std::max_element(away.begin(), away.end());
  for (int pass = 0; pass < 1000; ++pass) {
    // The iteration slows down near a median that is one of the points, so the nearest point is tested directly.
    const VectorXd z = nearest_point(points, x);
    if (derivatives_at(points, z).is_minimum()) {
      x = z;
      break;
    }
    const SumDerivatives derivatives = derivatives_at(points, x);
    if (derivatives.is_minimum()) break;
    const VectorXd by = step(points, x, derivatives);
    x += by;
    if (by.norm() <= 2 * std::numeric_limits<double>::epsilon() * size) break;
  }
  return {x.data(), x.data() + x.size()};
}

namespace {

/// Traces the offset of a center from its vertex. An offset that leaves the surface at once follows the boundary instead,
/// by its component along it.
Vec3 end_of_trace(const ExactGeodesics& geodesics, const Center& center) {
  constexpr double pi = std::numbers::pi;
  const exact::PolyhedralSurface& surface = geodesics.triangles().surface;
  double direction = std::atan2(center.offset[1], center.offset[0]), far = length(center.offset);
  if (direction < 0) direction += 2 * pi;
  if (const double sum = surface.angle_sum(center.vertex.index);
      surface.on_boundary(center.vertex.index) && direction > sum) {
    const double left = direction - sum, right = 2 * pi - direction;
    far *= std::max(0.0, std::cos(std::min(left, right)));
    direction = left < right ? sum : 0;
  }
  const exact::TracedPath way =
      exact::trace(surface, surface.vertex_point(center.vertex), direction, far / geodesics.triangles().length_unit);
  return geodesics.position(way.points.back());
}

Vec3 end_of_line(const TangentGraph& graph, const Center& center) {
  const Vec2 offset{center.offset[0], center.offset[1]};
  const TangentLine line = trace_line(graph, {center.vertex}, offset, length(offset));
  return position(graph, line.places.back()).value();
}

}  // namespace

Vec3 center_position(const Surface& surface, const Center& center) {
  const TangentGraph& graph = surface.graph();
  if (surface.positions().empty()) throw InvalidArgument("the surface has no positions");
  if (center.vertex.index < 0 || center.vertex.index >= graph.size() || center.offset.size() != 2)
    throw InvalidArgument("the center at vertex " + std::to_string(center.vertex.index) +
                          " belongs to another surface");
  const Frame frame = graph.frame(center.vertex.index).value();
  if (length(center.offset) == 0) return frame.origin;
  if (surface.faces().size() == 0) return end_of_line(graph, center);
  const FlatFaces faces(surface);
  if (faces.geodesics) return end_of_trace(*faces.geodesics, center);
  return surface.closest_point(frame.origin + center.offset[0] * frame.x + center.offset[1] * frame.y).position;
}

namespace {

/// Weighted points, and the kind of center.
struct Problem {
  const AnySolver& maps;
  const char* name;  ///< name of the center, for messages
  std::vector<double> (*flat_center)(const FlatPoints&);
  std::vector<Source> points = {};
  std::vector<std::size_t> numbers = {};  ///< indices of these points in the input
  std::vector<double> weights = {};       ///< > 0, the largest is 1
  bool frames = false;                    ///< a point may have an offset from its only vertex, so maps need frames
};

void check_vertex(const Problem& problem, Vertex vertex, const std::string& what) {
  if (vertex.index < 0 || vertex.index >= problem.maps.graph().size())
    throw InvalidArgument(std::string(problem.name) + ": " + what + ", vertex " + std::to_string(vertex.index) +
                          ", is outside [0, " + std::to_string(problem.maps.graph().size()) + ")");
}

/// Stores the points of positive weight.
void set_points(Problem& problem, std::span<const Source> points, std::span<const double> weights) {
  const std::string name = problem.name;
  if (points.empty()) throw InvalidArgument(name + ": there are no points");
  if (!weights.empty() && weights.size() != points.size())
    throw InvalidArgument(name + ": " + detail::counted(weights.size(), "weight") + " for " +
                          detail::counted(points.size(), "point"));
  double largest = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (Vertex vertex : points[k].vertices()) check_vertex(problem, vertex, "point " + std::to_string(k));
    const double w = weights.empty() ? 1.0 : weights[k];
    if (!(w >= 0) || !std::isfinite(w))
      throw InvalidArgument(name + ": weight " + std::to_string(k) + ", " + detail::number(w) +
                            ", must be finite and >= 0");
    if (w == 0) continue;
    problem.points.push_back(points[k]);
    problem.frames = problem.frames || (points[k].vertices().size() == 1 && !points[k].offsets().empty());
    problem.numbers.push_back(k);
    problem.weights.push_back(w);
    largest = std::max(largest, w);
  }
  if (problem.points.empty()) throw InvalidArgument(name + ": all weights are 0");
  for (double& w : problem.weights) w /= largest;
}

/// The vertex of largest weight in a point, where a search can start.
Vertex main_vertex(const Source& point) {
  const auto weights = point.weights();
  return point.vertices()[static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
}

/// The points in the map from a vertex, and their center there; lengths in graph units.
struct PointsInMap {
  LogMap map;
  FlatPoints points;
  std::vector<double> center;
};

/// @throws InvalidArgument if point k is not in the map
void check_in_map(const Problem& problem, const LogMap& map, Vertex from, std::size_t k) {
  for (Vertex vertex : problem.points[k].vertices()) {
    const Status status = map.status(vertex);
    if (status == Status::ok) continue;
    const char* what = status == Status::disconnected    ? "' (compute one center per component)"
                       : status == Status::beyond_radius ? "' (raise the radius)"
                                                         : "' (use a solver that marches)";
    throw InvalidArgument(std::string(problem.name) + ": in the map from vertex " + std::to_string(from.index) +
                          ", point " + std::to_string(problem.numbers[k]) + ", at vertex " +
                          std::to_string(vertex.index) + ", has status '" + std::string(to_string(status)) + what);
  }
}

/// The factor that scales phi to the length of the distance.
double distance_factor(const LogMap& map, Vertex vertex) {
  const double size = length(map.coordinates(vertex));
  return size > 0 ? map.distance(vertex) / size : 1;
}

/// The factor at a point: the weighted mean of the factors of its vertices.
double distance_factor(const LogMap& map, const Source& point) {
  double sum = 0, total = 0;
  for (std::size_t k = 0; k < point.vertices().size(); ++k) {
    sum += point.weights()[k] * distance_factor(map, point.vertices()[k]);
    total += point.weights()[k];
  }
  return sum / total;
}

PointsInMap map_points(const Problem& problem, Vertex from, double radius) {
  const TangentGraph& graph = problem.maps.graph();
  PointsInMap view{problem.maps.map(from, radius, problem.frames), {}, {}};
  view.points.dimension = static_cast<std::size_t>(graph.dimension());
  view.points.weights = problem.weights;
  for (std::size_t k = 0; k < problem.points.size(); ++k) {
    check_in_map(problem, view.map, from, k);
    const double scale = distance_factor(view.map, problem.points[k]) / graph.length_unit();
    for (double z : view.map.coordinates(problem.points[k])) view.points.coordinates.push_back(scale * z);
  }
  view.center = problem.flat_center(view.points);
  return view;
}

/// exp of `share` times the center: the vertex with the nearest coordinates. The search walks from neighbor to neighbor,
/// because beyond the cut locus other vertices have similar coordinates.
Vertex follow(const TangentGraph& graph, const PointsInMap& view, Vertex from, double share) {
  const auto away = [&](Index i) {
    const auto phi = view.map.coordinates(Vertex(i));
    const double scale = distance_factor(view.map, Vertex(i)) / graph.length_unit();
    double sum = 0;
    for (std::size_t a = 0; a < phi.size(); ++a) {
      const double difference = scale * phi[a] - share * view.center[a];
      sum += difference * difference;
    }
    return sum;
  };
  Index best = from.index;
  double least = away(best);
  for (Index at = -1; at != best;) {
    at = best;
    for (Index j : graph.star(at).neighbors)
      if (const double r = away(j); r < least) best = j, least = r;  // false for NaN
  }
  return Vertex(best);
}

double longest_edge(const TangentGraph& graph, Vertex vertex) {
  const Star star = graph.star(vertex.index);
  double longest = 0;
  for (std::size_t e = 0; e < star.degree(); ++e) longest = std::max(longest, length(star.log(e)));
  return longest;
}

/// Weighted power mean of the distances from the center.
double spread(const PointsInMap& view, double power) {
  const std::vector<double> away = distances(view.points, view.center);
  double sum = 0, total = 0;
  for (std::size_t k = 0; k < away.size(); ++k) {
    sum += view.points.weights[k] * std::pow(away[k], power);
    total += view.points.weights[k];
  }
  return std::pow(sum / total, 1 / power);
}

Center search(const Problem& problem, double power, const CenterOptions& options) {
  if (options.max_maps < 1)
    throw InvalidArgument(std::string(problem.name) + ": 'max_maps' " + std::to_string(options.max_maps) +
                          " must be at least 1");
  const TangentGraph& graph = problem.maps.graph();
  const auto heaviest = std::max_element(problem.weights.begin(), problem.weights.end()) - problem.weights.begin();
  Vertex x = options.start.value_or(main_vertex(problem.points[heaviest]));
  check_vertex(problem, x, "'start'");

  Center best;
  std::vector<Vertex> visited;
  double remaining = std::numeric_limits<double>::infinity(), share = 1;
  for (Index maps = 1; maps <= options.max_maps; ++maps) {
    const PointsInMap here = map_points(problem, x, options.radius);
    visited.push_back(x);
    if (const double r = length(here.center); r < remaining) {
      remaining = r;
      best.vertex = x;
      best.offset = here.center;
      best.spread = spread(here, power) * graph.length_unit();
      for (double& z : best.offset) z *= graph.length_unit();
    }
    best.maps = maps;
    // A step to a visited vertex would close a cycle; halve it.
    Vertex next = follow(graph, here, x, share);
    while (next != x && std::find(visited.begin(), visited.end(), next) != visited.end()) {
      share /= 2;
      next = share > 1e-6 ? follow(graph, here, x, share) : x;
    }
    if (next == x) {
      // A step that was halved to leave a cycle, or that no neighbor leads along, ends far from the center.
      best.converged = remaining <= longest_edge(graph, best.vertex);
      break;
    }
    x = next;
  }
  return best;
}

std::vector<Source> sources_at(std::span<const Vertex> vertices) {
  std::vector<Source> result;
  for (Vertex vertex : vertices) result.push_back(Source::at_vertex(vertex));
  return result;
}

}  // namespace

Center karcher_mean_of_points(const AnySolver& maps, std::span<const Source> points, std::span<const double> weights,
                              const CenterOptions& options) {
  Problem problem{maps, "mean", flat_mean};
  set_points(problem, points, weights);
  return search(problem, 2, options);
}

Center geometric_median_of_points(const AnySolver& maps, std::span<const Source> points,
                                  std::span<const double> weights, const CenterOptions& options) {
  Problem problem{maps, "median", flat_median};
  set_points(problem, points, weights);
  return search(problem, 1, options);
}

Center karcher_mean(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights,
                    const CenterOptions& options) {
  return karcher_mean_of_points(maps, sources_at(vertices), weights, options);
}

Center geometric_median(const AnySolver& maps, std::span<const Vertex> vertices, std::span<const double> weights,
                        const CenterOptions& options) {
  return geometric_median_of_points(maps, sources_at(vertices), weights, options);
}

Source source_at(const Center& center) {
  std::vector<double> back(center.offset);
  for (double& z : back) z = -z;
  return Source(static_cast<int>(back.size())).add(center.vertex, 1.0, back);
}

}  // namespace ahm
