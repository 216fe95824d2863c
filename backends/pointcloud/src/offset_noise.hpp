/// \file
/// Noise of a cloud across its surface, measured on the nearest neighbours of its points.
#pragma once

#include <span>
#include <vector>

#include "tangent_planes.hpp"

namespace ahm::pointcloud {

struct Noise {
  double deviation = 0;  ///< standard deviation of offsets; 0 on flat clouds up to rounding
  double layer_gap = 0;  ///< between the layers that the points lie in; 0: in one
};

/// How many ...
struct OffsetCounts {
  Offset points = 0;   ///< with neighbours
  Offset apart = 0;    ///< ... and an offset that is more than rounding
  Offset beside = 0;   ///< offsets of these beside the largest of each
  Offset between = 0;  ///< ... and near neither zero nor the largest
  Offset alike = 0;    ///< largest ones near their median
};

/// How many of these are near their median.
Offset count_alike(std::span<const double> largest, double median);

/// Absolute offsets of the nearest few neighbours of points across their mean planes, in units of the clean points.
struct NeighborOffsets {
  std::vector<double> all;
  std::vector<double> largest;  ///< of each point that is apart
  OffsetCounts counts;

  /// @param of_point  -1: of no plane
  /// @param radius    of its neighbourhood
  void add(std::span<const double> of_point, double radius);
};

NeighborOffsets neighbor_offsets(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                 const TangentPlanes& planes, Index begin, Index end, unsigned threads);

/// By the median of all offsets, which corners and other sheets do not move. Where points lie in layers as far apart everywhere, and
/// nearer than neighbours, as those of two scans or of the sides of a thin plate, that median is of the offsets within a layer or between
/// two, as it happens: there it is by the largest of each point.
/// @param all, largest  medians; 0 of none
Noise noise_of(const OffsetCounts& counts, double all, double largest);

Noise offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods, const TangentPlanes& planes,
                   unsigned threads);
/// The same of each of these parts.
std::vector<Noise> offset_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                const TangentPlanes& planes, const std::vector<std::vector<Index>>& parts,
                                unsigned threads);

/// Deviation of offsets around each point, in units of the clean points: the median over its neighborhood, which a crease or another
/// sheet beside it does not move.
std::vector<double> neighborhood_noise(const CleanPoints& cloud, const Neighborhoods& neighborhoods,
                                       const TangentPlanes& planes, unsigned threads);

}  // namespace ahm::pointcloud
