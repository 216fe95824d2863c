/// \file
/// Noise of a cloud across its surface, and smoothing.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cloud_parts.hpp"
#include "tangent_planes.hpp"

namespace ahm::pointcloud {

/// Noise measured on the nearest neighbors of points.
struct Noise {
  double deviation = 0;  ///< standard deviation of offsets; 0 on flat clouds up to rounding
  double layer_gap = 0;  ///< distance between the layers that contain the points; 0: one layer
};

/// Counts that detect layers.
struct OffsetCounts {
  Offset points = 0;   ///< points with neighbors
  Offset apart = 0;    ///< points with an offset that exceeds rounding
  Offset beside = 0;   ///< offsets at these points, without the largest one of each
  Offset between = 0;  ///< offsets at these points that are near neither zero nor the largest
  Offset alike = 0;    ///< largest offsets near their median
};

/// Number of largest offsets near their median.
Offset count_alike(std::span<const double> largest, double median);

/// Absolute offsets of the nearest neighbors across their mean planes, in units of the clean points.
struct NeighborOffsets {
  std::vector<double> all;
  std::vector<double> largest;  ///< largest offset of each point where it exceeds rounding
  OffsetCounts counts;

  /// Adds the offsets of one point.
  /// @param of_point  -1: no plane
  /// @param radius    radius of its neighborhood
  void add(std::span<const double> of_point, double radius);
};

/// Offsets of the points in [begin, end).
NeighborOffsets neighbor_offsets(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                 const TangentPlanes& planes, Index begin, Index end, unsigned threads);

/// Computes the noise from the median of all offsets, which corners and other sheets do not affect.
///
/// Points may also lie in layers at a constant distance that are nearer than neighbors, such as two scans or the sides of a
/// thin plate. That median is then an offset either within a layer or between two, by chance. In this case the largest offset
/// of each point is used.
/// @param all, largest  medians of the offsets; 0: no offsets
Noise noise_of(const OffsetCounts& counts, double all, double largest);

/// Noise of all points together.
Noise offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods, const TangentPlanes& planes,
                   unsigned threads);
/// Noise of each part.
std::vector<Noise> offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                const TangentPlanes& planes, const std::vector<std::vector<Index>>& parts,
                                unsigned threads);

/// Standard deviation of the offsets around each point, in units of the clean points: the median over its neighborhood, which a
/// crease or another sheet nearby does not affect.
std::vector<double> neighborhood_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                       const TangentPlanes& planes, unsigned threads);

/// Neighbors per point by default.
inline constexpr Index default_neighbors = 30;

/// Neighborhoods, tangent planes and noise of a cloud.
struct NoisyPlanes {
  Neighborhoods neighborhoods;
  TangentPlanes planes;
  std::unique_ptr<const CloudParts> parts;
  PerPart noise;        ///< standard deviation for each part
  Noise typical_noise;  ///< noise of the largest part, before smoothing
  Index merged = 0;     ///< number of points merged into another one
};

/// Finds neighbors and tangent planes of distinct points. Merges near points, smooths noisy ones, and repeats the search until no
/// point is noisy or none moves, at most five times. A radius in `CloudOptions::smooth` smooths once.
/// @param cloud, search  changed if points are merged or moved
NoisyPlanes find_noisy_planes(CleanPoints& cloud, std::span<const Vec3> normals,
                              std::unique_ptr<NeighborSearch>& search, const CloudOptions& options);

/// Marks the points of noisy surfaces: the standard deviation of neighbors' offsets exceeds a fraction of the spacing, in the median of
/// the whole part, or at most points around. A radius in `CloudOptions::smooth` marks all points, and 0 marks none.
std::vector<char> find_noisy_points(const CleanPoints& cloud, const NoisyPlanes& planes, const NeighborSearch& search,
                                    const CloudOptions& options);

/// Moves noisy points along the normals of their planes, and marks them in `cloud.smoothed`. Moves the points where the noise of the
/// neighborhood is large, or all points with a radius in `CloudOptions::smooth`. The fit ignores neighbors in other sheets. A point
/// stays in place if too few neighbors remain or the quadric is too far away.
/// @param planes  planes of the current points
/// @return whether a point moved
bool smooth_points(CleanPoints& cloud, const NoisyPlanes& planes, const std::vector<char>& noisy,
                   const NeighborSearch& search, const CloudOptions& options);

}  // namespace ahm::pointcloud
