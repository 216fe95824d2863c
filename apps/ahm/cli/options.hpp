/// \file
/// The command line as data.
#pragma once

#include <optional>
#include <string>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "cli/source_spec.hpp"

namespace ahm::app {

/// Where the u axis points.
struct UAxis {
  bool curvature = false;  ///< where the surface bends most, or
  Vec3 direction{};        ///< a vector of space
};

/// What subcommands that build a graph understand; each has the part it offers.
struct RunOptions {
  std::string input;
  std::string output;  ///< empty with `estimate` only
  SourceSpec source;
  std::optional<UAxis> u_axis;
  Variant variant = Variant::adaptive;
  std::string backend = "auto";  ///< auto, trimesh, polymesh, pointcloud
  double t_coef = 1.0;
  std::optional<double> radius;
  bool local = false;  ///< build the graph of a cloud around the source only; needs `radius`
  Ordering ordering = Ordering::amd;
  Strategy strategy = Strategy::automatic;
  int order = 1;
  double accuracy = SolverOptions{}.accuracy;
  bool gradient = false;  ///< columns with the direction away from the source
  bool estimate = false;  ///< tell what the run would cost instead of running

  std::optional<double> voxel;
  bool outliers = false;
  bool drop_nan = false;
  Index k = 30;
  std::string knn = "nanoflann";  ///< nanoflann, flann, pcl
  std::string normals = "auto";   ///< auto, oriented, unoriented, estimate

  std::string discretization = "auto";  ///< of polygon meshes: auto, polygons, refined
  bool flips = true;                    ///< intrinsic Delaunay triangulation of triangle meshes
  std::string non_manifold = "error";   ///< error, split

  std::string json;  ///< empty: none; "-": standard output
  std::string view;  ///< empty: none
  unsigned threads = 0;
  bool verbose = false;
};

/// `ahm info`
struct InfoOptions {
  std::string input;
  std::string json;
  Index k = 30;
  unsigned threads = 0;
};

}  // namespace ahm::app
