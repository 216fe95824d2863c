#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/quantile.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"
#include "noise.hpp"
#include "stream_median.hpp"
#include "surroundings.hpp"
#include "tangent_planes.hpp"

namespace ahm::tiles {
namespace {

/// Widths in neighborhood radii. A complete star depends on its own points, three rounds of dropping neighbors, the planes of neighbors,
/// and points that may be joined to it, at most three radii away. These are within eight of the largest radii, or ten typical radii.
/// The margin allows for edge flips, which may depend on points farther away.
constexpr double depends_on = 10, margin = 4;

/// Noise, as a share of the spacing, above which a cloud in memory uses more neighbors (point_cloud_surface.cpp).
constexpr double much_noise = 0.5;

/// 90th percentile of the neighborhood radii in a tile, from a sample.
double typical_radius(const TileFolder& folder, std::size_t tile) {
  const pointcloud::Placement placement = folder.placement();
  std::vector<Vec3> own;
  const ArrayFile file = folder.open(kind::points, tile);
  for (const Vec3& p : file.get<Vec3>("points")) own.push_back(placement.place(p));
  const auto search = pointcloud::nanoflann_search(own);
  std::vector<Index> indices(static_cast<std::size_t>(folder.manifest().k) + 1);
  std::vector<double> squared(indices.size()), radii;
  for (std::size_t i = 0; i < own.size(); i += own.size() / 2000 + 1) {
    const Index found = search->nearest(own[i], indices, squared);
    radii.push_back(std::sqrt(squared[found - 1]));
  }
  const double most = detail::value_at(radii, radii.size() * 9 / 10);
  return most > 0 ? most : 1e-3;
}

/// Whether the surroundings contain all points on which the tile and a margin around it depend.
bool suffices(const Surroundings& around, const std::vector<char>& complete, double width, double beyond) {
  for (std::size_t i = 0; i < complete.size(); ++i)
    if (!complete[i] && (around.covered[i] >= (width - beyond) * (1 - 1e-9))) return false;
  return true;
}

void write(const TileFolder& folder, std::size_t tile, const Surroundings& around,
           const pointcloud::Neighborhoods& near, const pointcloud::TangentPlanes& planes,
           const std::vector<char>& complete) {
  std::vector<double> spacings;
  for (Index i = around.begin; i < around.end; ++i) spacings.push_back(spacing_at(near, i));
  const pointcloud::NeighborOffsets offsets =
      neighbor_offsets(around.cloud, near, planes, around.begin, around.end, folder.options().threads);
  const pointcloud::OffsetCounts& c = offsets.counts;
  const std::vector<Offset> counts{c.points, c.apart, c.beside, c.between};
  const std::vector<Index> k{near.k};
  folder.write(kind::noise, tile,
               {array("offsets", offsets.all), array("largest", offsets.largest), array("counts", counts),
                array("spacings", spacings)});
  folder.write(kind::neighbors, tile,
               {array("begin", near.begin), array("indices", std::span<const Index>(near.indices)),
                array("radius", near.radius), array("k", k)});
  AroundFile::write(folder, tile, around, planes, complete);
}

/// The median of an array over all tiles; none if it is empty in all tiles.
std::optional<double> median(const TileFolder& folder, std::string_view name) {
  std::uint64_t size = 0;
  const auto of = [&](const ArrayFile& file) { return file.get<double>(name); };
  for (std::size_t t = 0; t < folder.tiles(); ++t) size += of(folder.open(kind::noise, t)).size();
  if (size == 0) return std::nullopt;
  StreamMedian result(size);
  while (!result.done()) {
    result.begin();
    for (std::size_t t = 0; t < folder.tiles(); ++t) {
      const ArrayFile file = folder.open(kind::noise, t);
      for (double value : of(file)) result.add(value);
    }
    result.end();
  }
  return result.value();
}

/// The counts of all tiles together. @param largest  median of the largest offsets
pointcloud::OffsetCounts offset_counts(const TileFolder& folder, double largest) {
  pointcloud::OffsetCounts sum;
  for (std::size_t t = 0; t < folder.tiles(); ++t) {
    const ArrayFile file = folder.open(kind::noise, t);
    const auto counts = file.get<Offset>("counts");
    sum.points += counts[0], sum.apart += counts[1], sum.beside += counts[2], sum.between += counts[3];
    sum.alike += pointcloud::count_alike(file.get<double>("largest"), largest);
  }
  return sum;
}

}  // namespace

/// Finds neighbors and tangent planes of a tile, with the surroundings that these and later steps depend on.
void find_planes(TileFolder& folder, std::size_t tile) {
  const double radius = typical_radius(folder, tile);
  const pointcloud::CloudOptions options = folder.cloud_options();
  for (double width = (depends_on + margin) * radius;; width *= 1.5) {
    const Surroundings around = gather(folder, tile, width);
    const WatchedSearch search(around);
    pointcloud::Neighborhoods near = find_neighborhoods(around.cloud, search, folder.manifest().k, options);
    const pointcloud::TangentPlanes planes = find_tangent_planes(around.cloud, {}, search, near, options);
    const std::vector<char> complete = search.complete(near, options.max_edge_ratio);
    if (!suffices(around, complete, width, margin * radius)) continue;
    return write(folder, tile, around, near, planes, complete);
  }
}

/// Measures the noise of the whole cloud. @throws InvalidGeometry (too noisy for 30 neighbors)
void measure_noise(TileFolder& folder) {
  const double all = median(folder, "offsets").value_or(0), largest = median(folder, "largest").value_or(0);
  Manifest& m = folder.manifest();
  m.noise = noise_of(offset_counts(folder, largest), all, largest).deviation;
  const double spacing = median(folder, "spacings").value_or(0);
  if (m.options.k == 0 && m.k == 30 && m.noise > much_noise * spacing)
    throw InvalidGeometry(
        "noisy_cloud",
        "the noise of the points across the surface is " + detail::number(m.noise / spacing) +
            " of their spacing, which requires more than 30 neighbors; tiles do not choose their number automatically",
        "plan them with k 60 or 120");
  folder.finish(Stage::measured);
}

}  // namespace ahm::tiles
