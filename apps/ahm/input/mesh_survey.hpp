/// \file
/// What `ahm info` finds out about the faces of a file, whether a map can be made on them or not.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/surface/mesh_topology.hpp"

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

}  // namespace ahm::app
