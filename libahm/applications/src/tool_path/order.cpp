#include "tool_path/order.hpp"

#include <algorithm>
#include <limits>

#include "ahm/util/vec.hpp"

namespace ahm {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

void reverse(TrackedPass& pass) { std::reverse(pass.track.begin(), pass.track.end()); }

/// Starts a closed pass at its point nearest to a position.
void start_near(TrackedPass& pass, const Vec3& position) {
  if (!pass.closed) return;
  Track& track = pass.track;
  track.pop_back();
  const auto nearest =
      std::ranges::min_element(track, {}, [&](const Spot& spot) { return distance(spot.position, position); });
  std::rotate(track.begin(), nearest, track.end());
  track.push_back(track.front());
}

/// Distance of a position from the nearest possible start of a pass.
double reach(const TrackedPass& pass, const Vec3& position, bool may_reverse) {
  if (!pass.closed)
    return may_reverse ? std::min(distance(pass.first(), position), distance(pass.last(), position))
                       : distance(pass.first(), position);
  double least = unlimited;
  const std::size_t stride = std::max<std::size_t>(1, pass.track.size() / 64);
  for (std::size_t k = 0; k < pass.track.size(); k += stride)
    least = std::min(least, distance(pass.track[k].position, position));
  return least;
}

/// Gives all passes the direction of the nearest pass that is nearer to the seed.
void align(std::vector<TrackedPass>& passes) {
  struct Sample {
    Vec3 position, direction;
  };
  std::vector<Sample> done;
  std::stable_sort(passes.begin(), passes.end(),
                   [](const TrackedPass& a, const TrackedPass& b) { return a.distance < b.distance; });
  const auto samples_of = [](const TrackedPass& pass) {
    std::vector<Sample> result;
    double walked = unlimited;
    for (std::size_t k = 0; k + 1 < pass.track.size(); ++k) {
      const Vec3 step = pass.track[k + 1].position - pass.track[k].position;
      if (walked >= 1) result.push_back({pass.track[k].position, step}), walked = 0;
      walked += norm(step);
    }
    return result;
  };
  for (TrackedPass& pass : passes) {
    double agreement = 0;
    const std::vector<Sample> own = samples_of(pass);
    const std::size_t stride = std::max<std::size_t>(1, own.size() / 8);
    for (std::size_t k = 0; k < own.size() && !done.empty(); k += stride) {
      const auto nearest = std::ranges::min_element(
          done, {}, [&](const Sample& sample) { return distance(sample.position, own[k].position); });
      agreement += dot(nearest->direction, own[k].direction);
    }
    if (agreement < 0) reverse(pass);
    const std::vector<Sample> now = samples_of(pass);
    done.insert(done.end(), now.begin(), now.end());
  }
}

/// Orders passes by their nearest ends, starting with the farthest pass from the seed.
std::vector<TrackedPass> by_nearest(std::vector<TrackedPass> passes, bool may_reverse) {
  std::vector<TrackedPass> result;
  std::vector<bool> used(passes.size(), false);
  std::size_t next = 0;
  for (std::size_t k = 1; k < passes.size(); ++k)
    if (passes[k].distance > passes[next].distance) next = k;
  while (result.size() < passes.size()) {
    used[next] = true;
    TrackedPass& pass = passes[next];
    if (!result.empty()) {
      const Vec3 from = result.back().last();
      if (pass.closed)
        start_near(pass, from);
      else if (may_reverse && distance(pass.last(), from) < distance(pass.first(), from))
        reverse(pass);
    }
    result.push_back(std::move(pass));
    const Vec3 from = result.back().last();
    double least = unlimited;
    for (std::size_t k = 0; k < passes.size(); ++k)
      if (!used[k])
        if (const double to = reach(passes[k], from, may_reverse); to < least) least = to, next = k;
  }
  return result;
}

/// Shortens the links by 2-opt exchanges: reverses runs of passes while that shortens the travel.
void exchange(std::vector<TrackedPass>& passes) {
  const std::size_t n = passes.size();
  const auto gap = [&](std::size_t a, bool a_reversed, std::size_t b, bool b_reversed) {
    return distance(a_reversed ? passes[a].first() : passes[a].last(),
                    b_reversed ? passes[b].last() : passes[b].first());
  };
  constexpr int max_sweeps = 30;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool improved = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) {
        // Reverses the run i ... j.
        double change = 0;
        if (i > 0) change += gap(i - 1, false, j, true) - gap(i - 1, false, i, false);
        if (j + 1 < n) change += gap(i, true, j + 1, false) - gap(j, false, j + 1, false);
        if (!(change < -1e-6)) continue;
        std::reverse(passes.begin() + static_cast<std::ptrdiff_t>(i),
                     passes.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        for (std::size_t k = i; k <= j; ++k) reverse(passes[k]);
        improved = true;
      }
    if (!improved) break;
  }
  for (std::size_t k = 1; k < n; ++k) start_near(passes[k], passes[k - 1].last());
}

}  // namespace

std::vector<TrackedPass> ordered(std::vector<TrackedPass> passes, bool one_way) {
  if (one_way) align(passes);
  passes = by_nearest(std::move(passes), !one_way);
  if (!one_way) exchange(passes);
  return passes;
}

}  // namespace ahm
