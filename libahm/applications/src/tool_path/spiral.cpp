// Closed level curves that follow each other, joined to spirals.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "ahm/util/disjoint_sets.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "tool_path/passes.hpp"

namespace ahm {
namespace {

using detail::Half;

/// A spiral replaces at least this many passes.
constexpr std::ptrdiff_t fewest_passes = 3;
// A spiral starts 0.4 below its first pass, and ends 0.4 above its last one. Its first and its last turn rise by half a
// spacing, all others by a spacing. So no turn is closer than 0.5 to another one or to the next pass beyond the spiral, and
// no point is farther than 0.6 from the path.
constexpr double overhang = 0.4, end_rise = 0.5;

/// A closed level curve between two parts of the surface.
struct Ring {
  MeshCurve curve;
  double level;
  bool is_pass;  ///< false: the overhang below a pass
  double length;
  Index below, above;  ///< numbers of the parts
};

/// What lies between two levels that follow each other, and is connected.
struct Part {
  std::vector<std::size_t> bottoms, tops;  ///< rings that it is above and below of
  bool has_boundary = false, has_open_curve = false;
};

/// Follows a level curve, and rises while it does.
class Riser {
 public:
  /// @param rings  whose lengths are the lengths of all levels in between
  Riser(const FaceMesh& mesh, std::span<const double> values, std::span<const Ring* const> rings)
      : mesh_(mesh), values_(values), rings_(rings) {}

  /// Rises from the first ring to the level `end`. @return whether the end was reached
  bool rise(double end) {
    const Ring& first = *rings_.front();
    begin_ = level_ = wanted_ = first.level, end_ = end;
    curve_.points.push_back(first.curve.points.front());
    Index face = first.curve.faces.front();
    Half entered = -1;
    for (Half h = 3 * face; h < 3 * face + 3; ++h)
      if (value(mesh_.tail(h)) >= level_ && value(mesh_.head(h)) < level_) entered = h;
    double walked = 0;
    for (int steps = 0; entered >= 0 && level_ < end_ && wanted_ - level_ < most_behind && steps < most_steps;
         ++steps) {
      const Half side = leave(entered);
      curve_.points.push_back(on_side(side, share(side)));
      curve_.faces.push_back(entered / 3);
      if (level_ >= std::min(wanted_, end_)) in_time_ = curve_.points.size();
      const std::size_t n = curve_.points.size();
      const double length = distance(mesh_.position(curve_.points[n - 2]), mesh_.position(curve_.points[n - 1]));
      if ((walked += length) > 1) walked = 0, steps = 0;
      wanted_ += length * slope();
      entered = mesh_.mirrored[to_size(side)] != 0 ? -1 : mesh_.twin[to_size(side)];
    }
    return level_ >= end_;
  }

  double level() const { return level_; }
  /// The path without turns around a peak, where the level does not rise.
  MeshCurve curve() && {
    curve_.points.resize(in_time_);
    curve_.faces.resize(in_time_ - 1);
    return std::move(curve_);
  }

 private:
  /// The level may fall behind at points that are lower than it; farther only around a peak.
  static constexpr double most_behind = 0.1;
  static constexpr int most_steps = 10'000;  ///< faces per spacing of length
  /// Share of a side up to which the level may rise on it: the path stays off the points of the mesh.
  static constexpr double most_along = 0.995;

  double value(Index point) const { return values_[to_size(point)]; }

  /// Selects the side of a face through which the curve leaves, and raises the level as far as that side permits. Larger values
  /// are on the left: the tail of the entered side is above the level, its head below.
  Half leave(Half entered) {
    const Half to_apex = detail::next(entered), from_apex = detail::previous(entered);
    const double above = value(mesh_.tail(entered)), apex = value(mesh_.tail(from_apex));
    const double wanted = std::min(wanted_, end_);
    // Along a row of points with nearly the same value, the level cannot rise: it passes over the row where it is behind.
    const bool is_apex_above = apex >= wanted || (above < wanted && apex - above >= wanted - apex);
    const Half side = is_apex_above ? to_apex : from_apex;
    const double from = value(mesh_.tail(side)), to = value(mesh_.head(side));
    level_ = std::max(level_, std::min(wanted, from + most_along * (to - from)));
    return side;
  }
  /// Place of the level on a side, from its tail.
  double share(Half side) const {
    const double from = value(mesh_.tail(side)), to = value(mesh_.head(side));
    return to > from ? std::clamp((level_ - from) / (to - from), 0.0, 1.0) : most_along;
  }
  /// Rise per length.
  double slope() const {
    const auto next = std::ranges::find_if(rings_, [&](const Ring* ring) { return ring->level > wanted_; });
    const auto upper = std::clamp<std::ptrdiff_t>(next - rings_.begin(), 1, std::ssize(rings_) - 1);
    const Ring &a = *rings_[to_size(upper - 1)], &b = *rings_[to_size(upper)];
    const double t = (wanted_ - a.level) / (b.level - a.level);
    const double length = std::max((1 - t) * a.length + t * b.length, shortest_pass);
    return (wanted_ < begin_ + end_rise || wanted_ >= end_ - end_rise ? end_rise : 1) / length;
  }

  const FaceMesh& mesh_;
  std::span<const double> values_;
  std::span<const Ring* const> rings_;
  double begin_ = 0, end_ = 0;
  double level_ = 0, wanted_ = 0;  ///< of the last point, and where it should be
  MeshCurve curve_;
  std::size_t in_time_ = 1;  ///< points up to the last one where the level was not behind
};

/// The level curves of the passes, and which of them follow each other.
class Levels {
 public:
  Levels(const FaceMesh& mesh, std::span<const double> values, double first, double farthest)
      : mesh_(mesh), values_(values) {
    for (double level = first; level - overhang < farthest; level += 1)
      for (const double at : {level - overhang, level}) thresholds_.push_back(at);
    find_rings(find_parts());
  }

  /// The spirals, and the levels that they do not replace.
  std::vector<PassCurve> passes() && {
    std::vector<bool> has_lower(rings_.size(), false);
    std::vector<std::optional<std::size_t>> upper(rings_.size());
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      const Part& part = parts_.at(rings_[r].above);
      if (part.bottoms.size() != 1 || part.tops.size() != 1 || part.has_boundary || part.has_open_curve) continue;
      upper[r] = part.tops.front();
      has_lower[part.tops.front()] = true;
    }
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      if (has_lower[r]) continue;
      std::vector<const Ring*> chain;
      for (std::optional<std::size_t> at = r; at; at = upper[*at]) chain.push_back(&rings_[*at]);
      join(chain);
    }
    return std::move(passes_);
  }

 private:
  /// The parts between the thresholds, as the smallest point of each.
  std::vector<Index> find_parts() {
    std::vector<std::ptrdiff_t> band;
    for (const double value : values_)  // -1 where the seed does not reach
      band.push_back(std::isnan(value) ? -1 : std::ranges::upper_bound(thresholds_, value) - thresholds_.begin());
    detail::DisjointSets sets(values_.size());
    for (std::size_t h = 0; h < mesh_.twin.size(); ++h) {
      const Index a = mesh_.tail(static_cast<Half>(h)), b = mesh_.head(static_cast<Half>(h));
      if (band[to_size(a)] == band[to_size(b)]) sets.join(a, b);
    }
    std::vector<Index> part;
    for (std::size_t p = 0; p < values_.size(); ++p) part.push_back(sets.root(static_cast<Index>(p)));
    for (std::size_t h = 0; h < mesh_.twin.size(); ++h)
      if (mesh_.twin[h] < 0)
        for (const Index p : {mesh_.tail(static_cast<Half>(h)), mesh_.head(static_cast<Half>(h))})
          parts_[part[to_size(p)]].has_boundary = true;
    return part;
  }

  void find_rings(const std::vector<Index>& part) {
    for (std::size_t t = 0; t < thresholds_.size(); ++t) {
      const double level = thresholds_[t];
      const bool is_pass = t % 2 == 1;
      for (MeshCurve& curve : level_curves(mesh_, values_, level)) {
        Index below = -1, above = -1;
        for (const Index p : mesh_.faces[to_size(curve.faces.front())])
          (values_[to_size(p)] >= level ? above : below) = part[to_size(p)];
        if (!curve.closed) {
          for (const Index p : {below, above}) parts_[p].has_open_curve = true;
          if (is_pass) passes_.push_back({std::move(curve), PassOrigin::level, level});
          continue;
        }
        const double length = curve_length(mesh_, curve);
        if (length < shortest_pass) continue;
        parts_[below].tops.push_back(rings_.size());
        parts_[above].bottoms.push_back(rings_.size());
        rings_.push_back({std::move(curve), level, is_pass, length, below, above});
      }
    }
  }

  /// Replaces rings that follow each other by a spiral. Where a spiral does not get through, two are made.
  void join(std::span<const Ring* const> chain) {
    if (std::ranges::count_if(chain, &Ring::is_pass) < fewest_passes) {
      for (const Ring* ring : chain)
        if (ring->is_pass) passes_.push_back({ring->curve, PassOrigin::level, ring->level});
      return;
    }
    const Ring& top = *chain.back();
    const Part& over = parts_.at(top.above);
    const bool is_open = over.bottoms.size() == 1 && over.tops.empty();  // a cap, or it ends at a boundary
    const double end = top.is_pass ? top.level + (is_open ? overhang : 0) : chain[chain.size() - 2]->level + overhang;
    Riser riser(mesh_, values_, chain);
    if (riser.rise(end) || (is_open && top.is_pass && riser.level() >= top.level)) {
      const double level = riser.level();
      passes_.push_back({std::move(riser).curve(), PassOrigin::spiral, (chain.front()->level + level) / 2});
      return;
    }
    const auto passed = std::ranges::count_if(chain, [&](const Ring* ring) { return ring->level <= riser.level(); });
    const std::size_t below = to_size(std::min(passed, std::ssize(chain) - 1));
    join(chain.first(below));
    join(chain.subspan(below));
  }

  const FaceMesh& mesh_;
  std::span<const double> values_;
  std::vector<double> thresholds_;  ///< the overhang of the first pass, the first pass, ...
  std::vector<Ring> rings_;
  std::map<Index, Part> parts_;
  std::vector<PassCurve> passes_;
};

}  // namespace

std::vector<PassCurve> spiral_levels(const FaceMesh& mesh, std::span<const double> distances, double first,
                                     double farthest) {
  return Levels(mesh, distances, first, farthest).passes();
}

}  // namespace ahm
