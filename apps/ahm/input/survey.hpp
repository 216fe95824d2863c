/// \file
/// What `ahm info` finds out about the faces of a file, whether a map can be made on them or not.
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

/// Of many lengths, world units.
struct LengthRange {
  double smallest = 0, median = 0, largest = 0;
  std::size_t count = 0;
};

/// @param lengths  any order; none: nothing
std::optional<LengthRange> range_of(std::vector<double> lengths);

struct MeshSurvey {
  std::map<std::size_t, std::size_t> faces_by_corners;
  std::size_t normals_against = 0;  ///< vertices whose given normal points to the back of the faces around
  std::size_t without_area = 0;     ///< faces whose corners lie on one line: to 1e-10 of their length, or to rounding
  MeshInspection inspection;
  std::optional<LengthRange> edges;  ///< each once; those between finite points

  /// Whether edges or vertices have to be cut before a map can be made.
  bool is_manifold() const {
    return inspection.topology.non_manifold_edges == 0 && inspection.topology.non_manifold_vertices == 0;
  }
};

/// @param input  with faces
MeshSurvey survey_mesh(const io::Geometry& input);

struct UnitGuess {
  std::string_view unit;  ///< empty: none
  std::string_view reason;
};

/// @param format     as `io::Geometry::format`
/// @param low, high  bounds of the points
UnitGuess guess_unit(std::string_view format, const Vec3& low, const Vec3& high);

/// The method, and what speaks for exact maps instead.
struct MethodAdvice {
  Method method = Method::heat;  ///< `Surface::suggested_method`
  bool exact_possible = false;
  std::string problem;  ///< why not
  /// Angles in degrees between the faces at an edge: half of the edges bend less, 5 % bend more.
  double median_bend = 0, sharp_bend = 0;
  bool exact_first = false;  ///< for single maps
};

/// Exact maps cost no more than a first one by heat up to `exact_vertices`, and other methods' vectors are as near on surfaces that
/// are sampled finely and smoothly (docs/results/exact.md).
MethodAdvice method_advice(const Surface& surface);

inline constexpr Index exact_vertices = 50000;
/// In degrees: where 5 % of the edges bend more, the surface is coarse or has sharp edges.
inline constexpr double fine_bend = 5;

std::string as_text(const MethodAdvice& advice);

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
