/// \file
/// The command line as data: groups of options, of which each subcommand composes what it offers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ahm/heat/heat_operators.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "cli/source_list.hpp"
#include "output/picture_options.hpp"

namespace ahm::app {

/// What is read, and how it becomes a surface.
struct InputOptions {
  std::string path;              ///< "-": standard input
  std::string format;            ///< extension; empty: as the path says
  std::string backend = "auto";  ///< or the name of one of `backends()`
  unsigned threads = 0;          ///< 0: one per core

  // Point clouds
  std::optional<double> voxel;
  std::vector<SourceSpec> named;  ///< points that the command names: --voxel keeps their rows
  bool outliers = false;
  bool drop_nan = false;
  bool around_source = false;   ///< build the graph only around the source,
  std::optional<double> local;  ///< as a map of this radius needs it
  std::optional<Index> k;
  std::string knn = "nanoflann";  ///< nanoflann, flann, pcl
  std::string normals = "auto";   ///< auto, oriented, unoriented, estimate
  std::optional<double> smooth;   ///< radius, 0: off; none: where there is noise

  // Meshes
  bool flips = true;                    ///< intrinsic Delaunay triangulation
  std::string non_manifold = "error";   ///< error, split
  std::string discretization = "auto";  ///< of polygons: auto, polygons, refined
  RepairOptions repair;
  std::vector<std::uint8_t> turned;  ///< with --local: as of `trimesh::MeshOptions`
};

/// How maps are computed.
struct SolveOptions : HeatOptions {
  std::optional<Method> method = Method::heat;  ///< none: the one that suits the surface
  std::optional<double> radius;
  double tolerance = 0;  ///< of exact maps
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

/// What is told on standard error and, in words, on standard output.
enum class Verbosity { quiet, normal, verbose };

/// What is told, and where. Empty: not at all.
struct OutputOptions {
  std::string output;       ///< a file, or `standard_output`
  std::string format;       ///< extension; empty: as the name says
  std::string json;         ///< "-": standard output
  bool json_lines = false;  ///< one line per summary, for several
  std::string view;
  PictureChoice picture;
  bool keep_existing = false;  ///< refuse to replace files
  Verbosity verbosity = Verbosity::normal;
};

/// The name that "-" stands for where something is written.
inline constexpr const char* standard_output = "/dev/stdout";

}  // namespace ahm::app
