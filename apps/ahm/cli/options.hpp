/// \file
/// The options of the command line as data, in groups from which the subcommands compose their own.
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

/// The input, and how a surface is built from it.
struct InputOptions {
  std::string path;              ///< "-": standard input
  std::string format;            ///< extension; empty: that of the path
  std::string backend = "auto";  ///< or the name of one of `backends()`
  unsigned threads = 0;          ///< 0: one per core

  // Point clouds
  std::optional<double> voxel;
  std::vector<SourceSpec> named;  ///< points in the command line: --voxel keeps their rows
  bool outliers = false;
  bool drop_nan = false;
  bool around_source = false;   ///< build the graph only around the source
  std::optional<double> local;  ///< radius of the map, with `around_source`
  bool all_components = false;  ///< no map from one source is made: no warning of other components
  std::optional<Index> k;
  std::string knn = "nanoflann";  ///< nanoflann, flann, pcl
  std::string normals = "auto";   ///< auto, oriented, unoriented, estimate
  std::optional<double> smooth;   ///< radius; 0: off; none: only where the cloud is noisy

  // Meshes
  bool flips = true;                    ///< intrinsic Delaunay triangulation
  std::string non_manifold = "error";   ///< error, split
  std::string discretization = "auto";  ///< of polygon meshes: auto, polygons, refined
  RepairOptions repair;
  std::vector<std::uint8_t> counts_as_reversed;  ///< with --local: `trimesh::MeshOptions::counts_as_reversed`
};

/// The input options that differ from the defaults, as command-line arguments, without the path.
std::vector<std::string> option_words(const InputOptions& options);

/// Options of the computation of maps.
struct SolveOptions : HeatOptions {
  std::optional<Method> method = Method::heat;  ///< none: the method that suits the surface
  std::string factor = "own";                   ///< own, cholmod, cholmod-simplicial; `solver` makes its factors
  std::optional<double> radius;
};

/// The direction of the u axis.
struct UAxis {
  bool curvature = false;  ///< the direction in which the surface bends most; false: `direction`
  Vec3 direction{};        ///< a vector in space
};

/// The source of a map.
struct SourceOptions {
  SourceSpec spec;
  std::optional<UAxis> u_axis;
};

/// The amount of text on standard error and standard output.
enum class Verbosity { quiet, normal, verbose };

/// The outputs of a command. Empty names: no such output.
struct OutputOptions {
  std::string output;       ///< a file, or `standard_output`
  std::string format;       ///< extension; empty: that of the name
  std::string json;         ///< "-": standard output
  bool json_lines = false;  ///< write each JSON summary on one line
  std::string view;
  PictureChoice picture;
  bool keep_existing = false;  ///< do not replace files
  Verbosity verbosity = Verbosity::normal;
};

/// The file name that "-" means for outputs.
inline constexpr const char* standard_output = "/dev/stdout";

}  // namespace ahm::app
