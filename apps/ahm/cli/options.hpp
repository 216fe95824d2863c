/// \file
/// The command line as data: groups of options, of which each subcommand composes what it offers.
#pragma once

#include <optional>
#include <string>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "cli/source_spec.hpp"
#include "output/picture_options.hpp"

namespace ahm::app {

/// What is read, and how it becomes a surface.
struct InputOptions {
  std::string path;
  std::string backend = "auto";  ///< or a name of the table in input/backends.cpp
  unsigned threads = 0;          ///< 0: one per core

  // Point clouds
  std::optional<double> voxel;
  bool outliers = false;
  bool drop_nan = false;
  std::optional<double> local;  ///< build the graph only around the source, as a map of this radius needs it
  std::optional<Index> k;
  std::string knn = "nanoflann";  ///< nanoflann, flann, pcl
  std::string normals = "auto";   ///< auto, oriented, unoriented, estimate

  // Meshes
  bool flips = true;                    ///< intrinsic Delaunay triangulation
  std::string non_manifold = "error";   ///< error, split
  std::string discretization = "auto";  ///< of polygons: auto, polygons, refined
};

/// How maps are computed.
struct SolveOptions : HeatOptions {
  Method method = Method::heat;
  std::optional<double> radius;
};

/// Where the u axis points.
struct UAxis {
  bool curvature = false;  ///< where the surface bends most, or
  Vec3 direction{};        ///< a vector of space
};

/// Where a map starts.
struct SourceOptions {
  SourceSpec spec;
  std::optional<UAxis> u_axis;
};

/// What is told, and where. Empty: not at all.
struct OutputOptions {
  std::string output;
  std::string json;  ///< "-": standard output
  std::string view;
  PictureChoice picture;
  bool verbose = false;
};

}  // namespace ahm::app
