/// \file
/// What `ahm info` finds out about a file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/progress.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Distances to the nearest other place of the cloud.
struct Spacing {
  double smallest = 0, median = 0, largest = 0;
  std::size_t sample = 0;  ///< points it was measured at
};

/// The neighbour graph of the points, as far as it can be built.
struct Connectivity {
  pointcloud::CloudDetails report;
  std::vector<std::string> warnings;
  std::vector<Index> component_sizes;  ///< vertices, largest first
  Index central_point = 0;             ///< input row in the largest component, near its middle: a source to start with
};

struct Survey {
  std::size_t points = 0, faces = 0, non_finite = 0, duplicates = 0;
  std::size_t bad_normals = 0;  ///< normals that are zero or not finite
  bool normals = false, colors = false;
  std::string format;
  std::vector<std::string> warnings;
  Vec3 low{}, high{};  ///< bounds of the finite points
  std::optional<Spacing> spacing;
  std::optional<Connectivity> connectivity;
  std::string problem;  ///< why there is no connectivity
};

/// Looks at everything. Failures to build a graph are findings, not errors.
/// @throws Cancelled, std::bad_alloc
Survey survey(const io::Geometry& input, const InputOptions& options, const Progress& progress);

/// The command line to run on this file, or empty when nothing can be run.
std::string suggestion(const Survey& survey, const std::string& path);

std::string as_text(const Survey& survey, const std::string& path);
nlohmann::ordered_json as_json(const Survey& survey, const std::string& path);

}  // namespace ahm::app
