#include "noisy_planes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "ahm/util/parallel.hpp"
#include "offset_noise.hpp"

namespace ahm::pointcloud {
namespace {

constexpr Index most_k = 120;

/// Noise of more than this share of the spacing bends planes more than corners do: more neighbours are taken.
constexpr double much_noise = 0.5;

/// Of one part, or of a cloud as if it were one.
struct PartPlanes {
  Neighborhoods neighborhoods;
  TangentPlanes planes;
  Noise noise;
};

/// Without the noise.
PartPlanes planes_and_neighborhoods(const CleanPoints& cloud, std::span<const Vec3> normals,
                                    const NeighborSearch& search, Index k, const CloudOptions& options) {
  PartPlanes result;
  result.neighborhoods = find_neighborhoods(cloud, search, k, options);
  result.planes = find_tangent_planes(cloud, normals, search, result.neighborhoods, options);
  return result;
}

PartPlanes find_planes(const CleanPoints& cloud, std::span<const Vec3> normals, const NeighborSearch& search, Index k,
                       const CloudOptions& options) {
  PartPlanes result = planes_and_neighborhoods(cloud, normals, search, k, options);
  result.noise = offset_noise(cloud, result.neighborhoods, result.planes, options.threads);
  return result;
}

/// More neighbours as long as they make neighbourhoods flatter.
PartPlanes widened(PartPlanes result, const CleanPoints& cloud, std::span<const Vec3> normals,
                   const NeighborSearch& search, const CloudOptions& options) {
  for (Index k = 2 * default_neighbors; k <= most_k; k *= 2) {
    if (!(result.noise.deviation > much_noise * spacing(result.neighborhoods)) || result.neighborhoods.k < k / 2) break;
    PartPlanes wider = find_planes(cloud, normals, search, k, options);
    if (wider.planes.thick > result.planes.thick) break;
    result = std::move(wider);
  }
  return result;
}

/// The noisy parts of a cloud of several, each looked at by itself, and what was found put in its place.
class NoisyParts {
 public:
  NoisyParts(const CleanPoints& cloud, std::span<const Vec3> normals, const CloudOptions& options)
      : cloud_(cloud), normals_(normals), options_(options) {}

  /// @param noise  of its points, which it takes the place of
  void widen(const std::vector<Index>& points, TangentPlanes& planes, Noise& noise) {
    CleanPoints part;
    part.unit = cloud_.unit;
    for (const Index i : points) {
      part.points.push_back(cloud_.points[i]);
      part.input.push_back(cloud_.input[i]);
    }
    CloudOptions quiet = options_;
    quiet.progress.report = nullptr;
    const auto search = options_.search(part.points);
    PartPlanes narrow = find_planes(part, normals_, *search, default_neighbors, quiet);
    const TangentPlanes before = narrow.planes;
    const PartPlanes wide = widened(std::move(narrow), part, normals_, *search, quiet);
    if (wide.neighborhoods.k <= default_neighbors) return;
    planes.estimated += wide.planes.estimated - before.estimated;
    planes.contradicted += wide.planes.contradicted - before.contradicted;
    planes.thick += wide.planes.thick - before.thick;
    for (std::size_t p = 0; p < points.size(); ++p) {
      planes.normals[points[p]] = wide.planes.normals[p];
      const auto of_part = wide.neighborhoods.of(static_cast<Index>(p));
      Found& found = found_.emplace_back(Found{points[p], {}, wide.neighborhoods.radius[p]});
      for (const Index j : of_part) found.neighbors.push_back(points[j]);
    }
    noise = wide.noise;
    if (wide.neighborhoods.k > k_ || (wide.neighborhoods.k == k_ && points.size() > size_))
      k_ = wide.neighborhoods.k, size_ = points.size(), noise_ = wide.noise;
  }

  void put_into(NoisyPlanes& all) {
    if (found_.empty()) return;
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.point < b.point; });
    Neighborhoods result{
        all.neighborhoods.k, {0}, {}, std::move(all.neighborhoods.radius), all.neighborhoods.unreachable};
    auto next = found_.begin();
    for (Index i = 0; i + 1 < static_cast<Index>(all.neighborhoods.begin.size()); ++i) {
      std::span<const Index> neighbors = all.neighborhoods.of(i);
      if (next != found_.end() && next->point == i) {
        neighbors = next->neighbors;
        result.radius[i] = next++->radius;
      }
      result.indices.insert(result.indices.end(), neighbors.begin(), neighbors.end());
      result.begin.push_back(static_cast<Offset>(result.indices.size()));
    }
    all.neighborhoods = std::move(result);
    all.k = k_;
    all.typical_noise = noise_;
  }

 private:
  struct Found {
    Index point;
    std::vector<Index> neighbors;
    double radius;
  };

  const CleanPoints& cloud_;
  std::span<const Vec3> normals_;
  const CloudOptions& options_;
  std::vector<Found> found_;
  Index k_ = 0;
  std::size_t size_ = 0;
  Noise noise_;
};

}  // namespace

NoisyPlanes find_noisy_planes(const CleanPoints& cloud, std::span<const Vec3> normals, const NeighborSearch& search,
                              const CloudOptions& options) {
  PartPlanes whole = planes_and_neighborhoods(cloud, normals, search, options.k.value_or(default_neighbors), options);
  NoisyPlanes result;
  const auto find_noise = [&] {
    whole.noise = offset_noise(cloud, whole.neighborhoods, whole.planes, options.threads);
  };
  const auto find_parts = [&] {
    result.parts = options.parts_apart ? std::make_unique<const CloudParts>(whole.neighborhoods)
                                       : std::make_unique<const CloudParts>(static_cast<Index>(cloud.points.size()));
  };
  detail::run_both(options.threads, find_noise, find_parts);
  if (result.parts->count == 1) {
    if (!options.k) whole = widened(std::move(whole), cloud, normals, search, options);
    result.neighborhoods = std::move(whole.neighborhoods);
    result.planes = std::move(whole.planes);
    result.noise = whole.noise.deviation;
    result.typical_noise = whole.noise;
    result.k = result.neighborhoods.k;
    return result;
  }
  result.neighborhoods = std::move(whole.neighborhoods);
  result.planes = std::move(whole.planes);
  result.k = result.neighborhoods.k;
  const auto points = result.parts->points();
  std::vector<Noise> noise = offset_noise(cloud, result.neighborhoods, result.planes, points, options.threads);
  const auto largest =
      std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  result.typical_noise = noise[static_cast<std::size_t>(largest - points.begin())];
  NoisyParts noisy(cloud, normals, options);
  for (std::size_t p = 0; p < points.size() && !options.k; ++p)
    if (static_cast<Index>(points[p].size()) > default_neighbors + 1 &&
        noise[p].deviation > much_noise * spacing(result.neighborhoods, points[p]))
      noisy.widen(points[p], result.planes, noise[p]);
  noisy.put_into(result);
  std::vector<double> deviations;
  for (const Noise& of_part : noise) deviations.push_back(of_part.deviation);
  result.noise = PerPart(result.parts->of_point, std::move(deviations));
  return result;
}

}  // namespace ahm::pointcloud
