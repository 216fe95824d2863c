#include "maps/extrapolate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/heat_distance.hpp"

namespace ahm {

DiffusionTimes::DiffusionTimes(int order, const TangentGraph& graph, const ComponentScales& scales)
    : count_(order == 1 ? 1 : 2), middle_(scales.sizes.size(), 1.0) {
  if (order == 1) return;
  for (std::size_t k = 0; k < middle_.size(); ++k) {
    const double c = std::pow(static_cast<double>(scales.sizes[k]), 1.0 / graph.dimension()) / 50;
    if (c < 2) continue;
    middle_[k] = c;
    count_ = 3;
  }
}

double DiffusionTimes::factor(std::size_t k, Index component) const {
  if (k == 0) return 1.0;
  return k + 1 == count_ ? 2 * middle_[component] : middle_[component];
}

namespace {

/// How much of the shortest time is kept, since phi is not smooth in sqrt(tau): where it changes faster than on smooth
/// surfaces, and where, with three times, heat of the longest comes along several ways and the two limits disagree by as
/// much as they correct.
double share_of_first(double rate, double c, double relative_disagreement, double relative_spread) {
  const double fast = std::clamp((rate - 3) / 2, 0.0, 1.0);
  if (!(c > 1) || !(relative_disagreement > 0.4)) return fast;
  return std::max(fast,
                  std::clamp(std::min((relative_disagreement - 0.4) / 0.4, (relative_spread - 0.1) / 0.1), 0.0, 1.0));
}

/// Lengths of the shortest ways along edges from a source, world units; infinite where there is none.
std::vector<double> edge_paths(const TangentGraph& graph, const Source& source) {
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> lengths(static_cast<std::size_t>(graph.size()), none);
  ShortestPaths<double, std::vector<double>> paths(lengths, none);
  const double unit = graph.length_unit();
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) paths.offer(source.vertices()[k].index, source.place(k).distance / unit);
  paths.run([&](Index vertex, double distance) {
    const Star star = graph.star(vertex);
    for (std::size_t e = 0; e < star.degree(); ++e) paths.offer(star.neighbors[e], distance + length(star.log(e)));
  });
  for (double& x : lengths) x *= unit;
  return lengths;
}

/// Moves phi towards p, which is no longer than `longest`, until phi is no longer either.
void shorten(std::span<double> phi, std::span<const double> p, double longest) {
  if (!(length(phi) > longest)) return;
  double a = 0, b = 0, c = 1;  // of a t^2 + 2 b t = c, in units of `longest`
  for (std::size_t k = 0; k < phi.size() && longest > 0; ++k) {
    const double from = p[k] / longest, way = (phi[k] - p[k]) / longest;
    a += way * way, b += from * way, c -= from * from;
  }
  const double t = longest > 0 ? std::clamp((std::sqrt(std::max(0.0, b * b + a * c)) - b) / a, 0.0, 1.0) : 0.0;
  for (std::size_t k = 0; k < phi.size(); ++k) phi[k] = p[k] + t * (phi[k] - p[k]);
}

constexpr double root_2_less_1 = std::numbers::sqrt2 - 1;

double gap(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum = std::hypot(sum, a[k] - b[k]);
  return sum;
}

/// phi at time 0, into `limit`, from those at the times c and 2 c.
/// @return how far it is from the same limit of the times 1 and c; with two times (c = 1), how far from phi at 1
double limit_of(std::span<const double> p1, std::span<const double> pc, std::span<const double> p2, double c,
                std::span<double> limit) {
  double disagreement = 0;
  for (std::size_t a = 0; a < limit.size(); ++a) {
    limit[a] = pc[a] - (p2[a] - pc[a]) / root_2_less_1;
    const double other = c > 1 ? (std::sqrt(c) * p1[a] - pc[a]) / (std::sqrt(c) - 1) : pc[a];
    disagreement = std::hypot(disagreement, limit[a] - other);
  }
  return disagreement;
}

}  // namespace

LogMap extrapolate(const TangentGraph& graph, const ComponentScales& scales, double t_coef, const DiffusionTimes& times,
                   const std::vector<const LogMap*>& maps, double radius) {
  const LogMap &first = *maps.front(), &middle = *maps[maps.size() - 2], &last = *maps.back();
  const auto n = static_cast<std::size_t>(first.size()), d = static_cast<std::size_t>(first.dimension());
  std::vector<double> coordinates(n * d, NAN), distances(n, NAN), error(n, NAN), limit(d);
  std::vector<Status> status(n, Status::ok);
  const bool is_curve = first.source().is_curve(), unfolded = unfolds(graph, first.source());
  const std::vector<double> paths = unfolded ? std::vector<double>() : edge_paths(graph, first.source());
  for (std::size_t i = 0; i < n; ++i) {
    const auto vertex = Vertex(i);
    for (const LogMap* map : maps)
      if (status[i] == Status::ok) status[i] = map->status(vertex);
    if (status[i] != Status::ok) continue;
    const double c = times.middle(scales.component(vertex.index));
    const double h = scales.h(vertex.index) * graph.length_unit();
    const double step = root_2_less_1 * std::sqrt(t_coef * c) * h;  // sqrt(tau_2c) - sqrt(tau_c)
    const auto p1 = first.coordinates(vertex), pc = middle.coordinates(vertex), p2 = last.coordinates(vertex);
    const double disagreement = limit_of(p1, pc, p2, c, limit);
    const double w = share_of_first(gap(p2, pc) / step, c, disagreement / gap(limit, p1),
                                    last.spread().empty() ? 0 : last.spread()[i] / std::max(last.distance(vertex), h));
    const std::span phi = std::span(coordinates).subspan(i * d, d);
    for (std::size_t a = 0; a < d; ++a) phi[a] = (1 - w) * limit[a] + w * p1[a];
    // Unfolded distances are the same at all times.
    const double r1 = first.distance(vertex), rc = middle.distance(vertex), r2 = last.distance(vertex);
    const double at_zero = std::max(0.0, rc - (r2 - rc) / root_2_less_1);
    distances[i] = r1 + (1 - w) * (at_zero - r1);
    if (!unfolded) distances[i] = std::min(distances[i], std::max(r1, paths[i]));
    if (!is_curve) shorten(phi, p1, std::max(length(p1), distances[i]));
    error[i] = std::max(gap(phi, limit), disagreement);
    if (!all_finite(phi))
      status[i] = Status::unreached;
    else if (distances[i] > radius)
      status[i] = Status::beyond_radius;
    if (status[i] == Status::ok) continue;
    std::fill(phi.begin(), phi.end(), NAN);
    distances[i] = error[i] = NAN;
  }
  const bool marched =
      std::any_of(maps.begin(), maps.end(), [](auto* map) { return map->strategy() == Strategy::march; });
  MapExtras extras{first.march(),
                   std::move(distances),
                   {first.spread().begin(), first.spread().end()},
                   {first.directions().begin(), first.directions().end()},
                   {middle.frames().begin(), middle.frames().end()},
                   std::move(error)};
  extras.radius = radius;
  for (std::size_t k = 1; k < maps.size(); ++k) extras.march += maps[k]->march();
  return LogMap(first.dimension(), first.variant(), marched ? Strategy::march : Strategy::global, first.source(),
                std::move(coordinates), std::move(status), std::move(extras));
}

}  // namespace ahm
