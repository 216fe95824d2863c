/// \file
/// PCL's voxel grid, outlier removal and normal estimation on plain arrays, with indices into the input.
///
/// \code
/// auto reduced = ahm::pcl_bridge::voxel_grid(points, normals, 0.01);
/// auto kept = ahm::pcl_bridge::outlier_removal(reduced.points);             // indices into reduced.points
/// ahm::Index input = reduced.point_of_row[kept[0]];                  // index into points
/// \endcode
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::pcl_bridge {

/// A cloud with one point per occupied voxel. Rows are in the order of the input points.
struct ReducedCloud {
  std::vector<Vec3> points;         ///< the input point that represents each voxel
  std::vector<Vec3> normals;        ///< normal of each of these points; empty if the input has no normals
  std::vector<Index> point_of_row;  ///< input index of each row, ascending
  std::vector<Index> row_of_point;  ///< for each input point, the row that represents its voxel
};

/// Thins a cloud with `pcl::VoxelGrid`. The point nearest to PCL's centroid represents its voxel, so that positions and indices
/// remain those of input points.
/// @param normals  empty or one per point
/// @param size     edge length of a voxel, > 0
/// @throws InvalidArgument (size; a size so small that PCL's 32-bit voxel numbers overflow; lengths of the arrays),
///         InvalidGeometry (a coordinate is not finite)
ReducedCloud voxel_grid(std::span<const Vec3> points, std::span<const Vec3> normals, double size);

/// Removes outliers with `pcl::StatisticalOutlierRemoval`. Keeps the points whose mean distance to `mean_k` neighbors is at
/// most the mean of these distances over the cloud plus `stddev_mul` standard deviations.
/// @param mean_k  >= 1; clamped to n - 1
/// @return indices of the points kept, ascending
/// @throws InvalidArgument (mean_k, stddev_mul), InvalidGeometry (a coordinate is not finite)
std::vector<Index> outlier_removal(std::span<const Vec3> points, int mean_k = 16, double stddev_mul = 2.0);

/// Estimates unit normals with `pcl::NormalEstimationOMP`: the direction of least variance of the k nearest points, with
/// arbitrary sign.
/// @param k        >= 3; clamped to n
/// @param threads  0: one per core
/// @return one normal per point, NaN where PCL finds none
/// @throws InvalidArgument (k, fewer than 3 points), InvalidGeometry (a coordinate is not finite)
std::vector<Vec3> estimate_normals(std::span<const Vec3> points, int k = 30, unsigned threads = 0);

}  // namespace ahm::pcl_bridge
