/// \file
/// What `ahm info` finds out about a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/progress.hpp"
#include "ahm/report.hpp"
#include "cli/options.hpp"
#include "input/mesh_survey.hpp"
#include "input/method_advice.hpp"

namespace ahm::app {

/// The surface that maps are made on, as it was built.
struct SurfaceSurvey {
  Report report;
  std::vector<Index> part_sizes;  ///< vertices of the input in each part, largest first
  Index central_row = 0;          ///< in the largest part, near its middle: a source to start with
  std::string options;            ///< that it takes, each after a blank
  MethodAdvice method;
};

/// What --repair would do.
struct RepairSurvey {
  RepairCounts counts;
  Index parts = 0;  ///< of the mesh when it has been done; 0: no face remains
};

struct Survey {
  std::size_t points = 0, faces = 0, non_finite = 0, duplicates = 0;
  std::size_t bad_normals = 0;  ///< normals that are zero or not finite
  bool normals = false, colors = false;
  std::string format;
  std::vector<std::string> columns;  ///< further numbers by point
  std::optional<io::Acquisition> acquisition;
  std::vector<std::string> warnings;
  Vec3 low{}, high{};                    ///< bounds of the finite points
  std::optional<MeshSurvey> mesh;        ///< where there are faces
  std::optional<RepairSurvey> repair;    ///< likewise
  std::optional<LengthRange> spacing;    ///< where there are none: to the nearest other place, of a sample
  std::optional<SurfaceSurvey> surface;  ///< of the faces, or else of the points alone
  bool as_cloud = false;                 ///< the surface has the points alone
  std::string problem;                   ///< why there is no surface, or none of the faces
};

/// Looks at everything. Failures to build a surface are findings, not errors.
/// @throws Cancelled, std::bad_alloc
Survey survey(const io::Geometry& input, const InputOptions& options, const Progress& progress);

}  // namespace ahm::app
