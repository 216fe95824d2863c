#include "maps/extrapolate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"
#include "maps/edge_paths.hpp"
#include "maps/heat_distance.hpp"

namespace ahm {

double middle_time(double vertices, int dimension) {
  constexpr double least = 1.5;
  const double c = std::pow(vertices, 1.0 / dimension) / 50;
  return c < 1 ? 1 : std::max(c, least);
}

DiffusionTimes::DiffusionTimes(int order, int dimension, std::span<const Index> sizes)
    : count_(order == 1 ? 1 : 2), middle_(sizes.size(), 1.0) {
  if (order == 1) return;
  for (std::size_t k = 0; k < middle_.size(); ++k) {
    middle_[k] = middle_time(static_cast<double>(sizes[k]), dimension);
    if (middle_[k] > 1) count_ = 3;
  }
}

double DiffusionTimes::factor(std::size_t k, Index component) const {
  if (k == 0) return 1.0;
  return k + 1 == count_ ? 2 * middle_[component] : middle_[component];
}

double DiffusionTimes::radius_of_each(double radius, std::span<const double> edge_lengths, double unit) const {
  return count_ == 1 ? radius : radius + 8 * *std::max_element(edge_lengths.begin(), edge_lengths.end()) * unit;
}

namespace {

constexpr double root_2_less_1 = std::numbers::sqrt2 - 1;

/// 0 up to `low`, 1 from `high` on.
double ramp(double x, double low, double high) { return std::clamp((x - low) / (high - low), 0.0, 1.0); }

/// How much of the shortest time is kept, since phi is not smooth in sqrt(tau): where it changes faster than on smooth surfaces.
double share_by_rate(double rate) { return ramp(rate, 3, 5); }

/// With three times: where heat of the longest comes along several ways and the two limits disagree by as much as they correct.
double share_by_limits(double relative_disagreement, double relative_spread) {
  return std::min(ramp(relative_disagreement, 0.4, 0.8), ramp(relative_spread, 0.1, 0.2));
}

/// Distances of heat from one source at the times 1, c and 2 c, and how wide its ways spread at the first and the last.
struct TimedDistance {
  double first, middle, last;
  double first_spread, last_spread;
  /// At time 0; not below 0.
  double limit() const { return std::max(0.0, middle - (last - middle) / root_2_less_1); }
};

/// How far the variance of the ways of heat is from growing with sqrt(tau), as it does where the map is smooth in that.
double doubt_by_spread(const TimedDistance& r, double c) {
  const double ratio = r.last_spread / r.first_spread;  // not the squares, which numbers may not hold
  return r.first_spread > 0 ? std::abs(ratio * ratio / std::sqrt(2 * c) - 1) : 0.0;
}

/// How much of the shortest time's distance is kept, at least `by_rate`: all of it where the limit is farther away than on smooth
/// surfaces, where heat spreads otherwise than on them, where edges do not follow the way, as between points
/// that are much denser one way than the other, and where, with three times, the two limits disagree by as much as they
/// correct.
double share_of_first_distance(double by_rate, const TimedDistance& r, double c, double path) {
  if (!(r.first > 0)) return by_rate;
  const double correction = std::abs(r.limit() - r.first);
  const double share = std::max({by_rate, ramp(correction / r.first, 0.02, 0.04),
                                 ramp(doubt_by_spread(r, c), 0.1, 0.25), ramp(path / r.first, 1.1, longest_way)});
  if (!(c > 1) || !(correction > 0)) return share;
  const double other = (std::sqrt(c) * r.first - r.middle) / (std::sqrt(c) - 1);
  return std::max(share, ramp(std::abs(r.limit() - other) / correction, 0.25, 0.5));
}

/// Lengths of the shortest ways along edges from a source, world units; infinite where there is none.
std::vector<double> all_edge_paths(const TangentGraph& graph, const Source& source) {
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> lengths(static_cast<std::size_t>(graph.size()), none);
  edge_paths(graph, source, none, {}, [&](Index vertex, double length) { lengths[vertex] = length; });
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

/// Turns frames by what extrapolation turned vectors by, so that a vector and the way it arrives by, U phi, stay together: at the shortest
/// time the errors of both make up for each other. In the plane.
void turn_back(std::span<double> frames, const LogMap& first, std::span<const double> coordinates) {
  for (std::size_t i = 0; 4 * i < frames.size(); ++i) {
    const std::span<const double> before = first.coordinates(Vertex(i)), phi = coordinates.subspan(2 * i, 2);
    const double size = length(before) * length(phi);
    if (!(size > 0)) continue;
    const double c = (phi[0] * before[0] + phi[1] * before[1]) / size,
                 s = (phi[0] * before[1] - phi[1] * before[0]) / size;
    for (double* row = &frames[4 * i]; row != &frames[4 * i] + 4; row += 2) {
      const double x = row[0], y = row[1];
      row[0] = c * x + s * y;
      row[1] = c * y - s * x;
    }
  }
}

}  // namespace

ExtrapolatedRow extrapolate_row(const std::array<TimedRow, 3>& rows, const ExtrapolationScales& scales,
                                DistanceKind kind, double path, double radius, std::span<double> phi) {
  std::fill(phi.begin(), phi.end(), NAN);
  for (const TimedRow& row : rows)
    if (row.status != Status::ok) return {row.status, NAN, NAN};
  const auto& [first, middle, last] = rows;
  const double c = scales.middle;
  const double step = root_2_less_1 * std::sqrt(scales.t_coef * c) * scales.h;  // sqrt(tau_2c) - sqrt(tau_c)
  Scratch at_zero(phi.size());
  const std::span<double> limit = at_zero.span();
  const double disagreement = limit_of(first.phi, middle.phi, last.phi, c, limit);
  const double by_rate = share_by_rate(gap(last.phi, middle.phi) / step), correction = gap(limit, first.phi);
  const bool has_limits = c > 1 && correction > 0;
  const double by_limits =
      has_limits ? share_by_limits(disagreement / correction, last.spread / std::max(last.distance, scales.h)) : 0;
  const double w = std::max(by_rate, by_limits);
  for (std::size_t a = 0; a < phi.size(); ++a) phi[a] = (1 - w) * limit[a] + w * first.phi[a];
  const TimedDistance r{first.distance, middle.distance, last.distance, first.spread, last.spread};
  double distance = r.first;
  if (!kind.unfolded) {
    distance += (1 - share_of_first_distance(by_rate, r, c, path)) * (r.limit() - r.first);
    distance = std::min(distance, std::max(r.first, path));
  }
  if (!kind.of_curve) shorten(phi, first.phi, std::max(length(first.phi), distance));
  if (all_finite(phi) && !(distance > radius)) return {Status::ok, distance, std::max(gap(phi, limit), disagreement)};
  const Status status = all_finite(phi) ? Status::beyond_radius : Status::unreached;
  std::fill(phi.begin(), phi.end(), NAN);
  return {status, NAN, NAN};
}

LogMap extrapolate(const TangentGraph& graph, const ComponentScales& scales, double t_coef, const DiffusionTimes& times,
                   const std::vector<const LogMap*>& maps, double radius, bool with_distances, bool with_spread) {
  const std::array<const LogMap*, 3> of_times{maps.front(), maps[maps.size() - 2], maps.back()};
  const LogMap& first = *of_times[0];
  const auto n = static_cast<std::size_t>(first.size()), d = static_cast<std::size_t>(first.dimension());
  std::vector<double> coordinates(n * d), distances(n), error(n);
  std::vector<Status> status(n);
  const DistanceKind kind{unfolds(graph, first.source()), first.source().is_curve()};
  const std::vector<double> paths = kind.unfolded ? std::vector<double>() : all_edge_paths(graph, first.source());
  for (std::size_t i = 0; i < n; ++i) {
    const auto vertex = Vertex(i);
    const auto row = [&](const LogMap& map) {
      return TimedRow{map.status(vertex), map.coordinates(vertex), map.distance(vertex),
                      map.spread().empty() ? 0 : map.spread()[i]};
    };
    const double h = scales.h(vertex.index) * graph.length_unit();
    const ExtrapolatedRow found =
        extrapolate_row({row(*of_times[0]), row(*of_times[1]), row(*of_times[2])},
                        {t_coef, times.middle(scales.component(vertex.index)), h}, kind, kind.unfolded ? 0 : paths[i],
                        radius, std::span(coordinates).subspan(i * d, d));
    status[i] = found.status;
    distances[i] = found.distance;
    error[i] = found.error;
  }
  const bool marched =
      std::any_of(maps.begin(), maps.end(), [](auto* map) { return map->strategy() == Strategy::march; });
  MapExtras extras;
  extras.march = first.march();
  extras.frames.assign(first.frames().begin(), first.frames().end());
  if (d == 2 && !kind.of_curve) turn_back(extras.frames, first, coordinates);
  extras.error_estimate = std::move(error);
  if (with_distances) {
    extras.distances = std::move(distances);
    extras.directions.assign(first.directions().begin(), first.directions().end());
    extras.direction_errors.assign(first.direction_errors().begin(), first.direction_errors().end());
    extras.nearest.assign(first.nearest().begin(), first.nearest().end());
  }
  if (with_spread) extras.spread.assign(first.spread().begin(), first.spread().end());
  extras.radius = radius;
  for (std::size_t k = 1; k < maps.size(); ++k) extras.march += maps[k]->march();
  return LogMap(first.dimension(), first.variant(), marched ? Strategy::march : Strategy::global, first.source(),
                std::move(coordinates), std::move(status), std::move(extras));
}

}  // namespace ahm
