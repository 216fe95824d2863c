/// \file
/// The examination of a file by `ahm info`, also of files from which no map can be made.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/progress.hpp"
#include "ahm/report.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/surface.hpp"
#include "ahm/types.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Smallest, median and largest of several lengths, world units.
struct LengthRange {
  double smallest = 0, median = 0, largest = 0;
  std::size_t count = 0;
};

/// The range of some lengths; none if there are no lengths.
std::optional<LengthRange> range_of(std::vector<double> lengths);

/// Findings about the faces of a file.
struct MeshSurvey {
  std::map<std::size_t, std::size_t> faces_by_corners;
  std::size_t normals_against = 0;  ///< vertices whose normal in the file points to the back of their faces
  std::size_t without_area = 0;     ///< faces with collinear corners, to 1e-10 of their length or to rounding
  MeshInspection inspection;
  std::optional<LengthRange> edges;  ///< lengths of the edges between finite points, each edge once

  /// Whether no edges or vertices have to be split before a map can be made.
  bool is_manifold() const {
    return inspection.topology.non_manifold_edges == 0 && inspection.topology.non_manifold_vertices == 0;
  }
};

/// Examines the faces. @param input  with faces
MeshSurvey survey_mesh(const io::Geometry& input);

/// The probable unit of the coordinates, and the reason.
struct UnitGuess {
  std::string_view unit;  ///< empty: unknown
  std::string_view reason;
};

/// Guesses the unit from the format and size.
/// @param format     `io::Geometry::format`
/// @param low, high  bounds of the points
UnitGuess guess_unit(std::string_view format, const Vec3& low, const Vec3& high);

/// The suggested method, and when exact maps are better.
struct MethodAdvice {
  Method method = Method::heat;  ///< `Surface::suggested_method`
  bool exact_possible = false;
  std::string problem;  ///< why exact maps are not possible
  /// Median and 95th percentile of the angle between the faces at an edge, degrees.
  double median_bend = 0, sharp_bend = 0;
  bool exact_first = false;  ///< exact maps are suggested for single maps
};

/// The advice for a surface. Up to `exact_vertices` an exact map takes at most as long as a first map by heat. On finely sampled, smooth
/// surfaces the vectors of the other methods are as accurate (docs/results/exact.md).
MethodAdvice method_advice(const Surface& surface);

inline constexpr Index exact_vertices = 50000;
/// If 5 % of the edges bend by more than this angle, degrees, the surface is coarse or has sharp edges.
inline constexpr double fine_bend = 5;

std::string as_text(const MethodAdvice& advice);

/// Findings about the surface that was built.
struct SurfaceSurvey {
  Report report;
  std::vector<Index> part_sizes;  ///< vertices of the input in each part, largest first
  Index central_row = 0;          ///< a row near the middle of the largest part, suggested as source
  std::string options;            ///< options of the suggested command, each after a blank
  MethodAdvice method;
};

/// The effect that --repair would have.
struct RepairSurvey {
  RepairCounts counts;
  Index parts = 0;  ///< parts of the repaired mesh; 0: no face remains
};

/// All findings about a file.
struct Survey {
  std::size_t points = 0, faces = 0, non_finite = 0, duplicates = 0;
  std::size_t bad_normals = 0;  ///< normals that are zero or not finite
  bool normals = false, colors = false;
  std::string format;
  std::vector<std::string> columns;  ///< names of additional columns
  std::optional<io::Acquisition> acquisition;
  std::vector<std::string> warnings;
  Vec3 low{}, high{};                  ///< bounds of the finite points
  std::optional<MeshSurvey> mesh;      ///< if there are faces
  std::optional<RepairSurvey> repair;  ///< if there are faces
  std::optional<LengthRange> spacing;  ///< if there are no faces: distance to the nearest distinct point, for a sample
  std::optional<SurfaceSurvey> surface;  ///< surface of the faces, otherwise of the points; none: not possible
  bool as_cloud = false;                 ///< the surface is built from the points, without faces
  std::string problem;                   ///< why no surface can be built from the faces, or at all
};

/// Examines a file. Failures to build a surface are findings, not errors.
/// @throws Cancelled, std::bad_alloc
Survey survey(const io::Geometry& input, const InputOptions& options, const Progress& progress);

}  // namespace ahm::app
