#include "noisy_planes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "merge_points.hpp"
#include "smooth_points.hpp"

namespace ahm::pointcloud {
namespace {

/// Each round averages over one neighborhood more; the noise of a whole spacing is gone after three.
constexpr int most_rounds = 5;

void find_noise(const CleanPoints& cloud, const CloudOptions& options, NoisyPlanes& result) {
  Noise whole;
  detail::run_both(
      options.threads, [&] { whole = offset_noise(cloud, result.neighborhoods, result.planes, options.threads); },
      [&] {
        result.parts = options.parts_apart
                           ? std::make_unique<const CloudParts>(result.neighborhoods)
                           : std::make_unique<const CloudParts>(static_cast<Index>(cloud.points.size()));
      });
  result.noise = whole.deviation;
  result.typical_noise = whole;
  if (result.parts->count == 1) return;
  const auto points = result.parts->points();
  const std::vector<Noise> noise = offset_noise(cloud, result.neighborhoods, result.planes, points, options.threads);
  const auto largest =
      std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  result.typical_noise = noise[static_cast<std::size_t>(largest - points.begin())];
  std::vector<double> deviations;
  for (const Noise& of_part : noise) deviations.push_back(of_part.deviation);
  result.noise = PerPart(result.parts->of_point, std::move(deviations));
}

NoisyPlanes find_planes(CleanPoints& cloud, std::span<const Vec3> normals, std::unique_ptr<NeighborSearch>& search,
                        const CloudOptions& options) {
  NoisyPlanes result;
  result.neighborhoods = find_neighborhoods(cloud, *search, options.k.value_or(default_neighbors), options);
  result.merged = merge_near_points(cloud, search, options, result.neighborhoods);
  result.planes = find_tangent_planes(cloud, normals, *search, result.neighborhoods, options);
  find_noise(cloud, options, result);
  return result;
}

}  // namespace

NoisyPlanes find_noisy_planes(CleanPoints& cloud, std::span<const Vec3> normals,
                              std::unique_ptr<NeighborSearch>& search, const CloudOptions& options) {
  NoisyPlanes result = find_planes(cloud, normals, search, options);
  CloudOptions quiet = options;
  quiet.progress.report = nullptr;
  const int rounds = options.smooth ? 1 : most_rounds;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<char> noisy = find_noisy_parts(cloud, result, *search, options);
    if (std::find(noisy.begin(), noisy.end(), 1) == noisy.end() ||
        !smooth_points(cloud, result, noisy, *search, options))
      break;
    search = options.search(cloud.points);
    NoisyPlanes smoothed = find_planes(cloud, normals, search, quiet);
    smoothed.typical_noise = result.typical_noise;
    smoothed.merged += result.merged;
    result = std::move(smoothed);
  }
  return result;
}

}  // namespace ahm::pointcloud
