#include <algorithm>
#include <mutex>
#include <numeric>
#include <tuple>

#include "ahm/surface/exact/geodesic_path.hpp"
#include "ahm/util/parallel.hpp"

namespace ahm::exact {
namespace {

auto key(const MeshPoint& point) { return std::tie(point.face, point.barycentric); }

/// Numbers of pairs with the same start.
std::vector<std::vector<std::size_t>> by_start(std::span<const PointPair> pairs) {
  std::vector<std::size_t> order(pairs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(pairs[a][0]) < key(pairs[b][0]); });
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || key(pairs[order[k - 1]][0]) != key(pairs[order[k]][0])) groups.emplace_back();
    groups.back().push_back(order[k]);
  }
  return groups;
}

}  // namespace

std::vector<GeodesicPath> geodesic_paths(const PolyhedralSurface& surface, std::span<const PointPair> pairs,
                                         const Progress& progress, unsigned threads) {
  const std::vector<std::vector<std::size_t>> groups = by_start(pairs);
  std::vector<GeodesicPath> paths(pairs.size());
  std::mutex reporting;
  std::size_t done = 0;
  detail::parallel_chunks(static_cast<Offset>(groups.size()), 1, threads, [&](Offset g, Offset) {
    const std::vector<std::size_t>& group = groups[static_cast<std::size_t>(g)];
    ExactOptions options;
    options.progress.stop = progress.stop;
    options.only_targets = true;
    for (std::size_t k : group) options.targets.push_back(pairs[k][1]);
    const ExactMap map = exact_map(surface, pairs[group.front()][0], options);
    for (std::size_t t = 0; t < group.size(); ++t) paths[group[t]] = path_to_target(surface, map, t);
    const std::scoped_lock lock(reporting);
    progress.step("paths", static_cast<double>(++done) / static_cast<double>(groups.size()));
  });
  return paths;
}

}  // namespace ahm::exact
