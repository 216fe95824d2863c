/// \file
/// The faces around the source, for --local.
#pragma once

#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Some faces of a mesh, with the orientation and parts of the whole mesh.
struct Surroundings {
  std::vector<Index> faces;  ///< the kept faces, ascending
  /// Parts and orientation of all faces, so that the kept faces are oriented as in the whole mesh. Empty if no surface can be built
  /// from all faces.
  FaceParts whole;

  /// For each of `faces`: 1 if it is reversed in the surface of all faces.
  std::vector<std::uint8_t> counts_as_reversed() const;
  /// For each vertex the part of its last face, -1 if no face uses it.
  /// @param input  with all faces
  std::vector<Index> part_of_vertices(const io::Geometry& input) const;
};

/// The faces within 1.5 radii of the source in a straight line; for a position, of the vertex nearest to it. Paths up to the radius
/// stay within one radius, and the additional half keeps the new boundary away from them. Where kept faces would touch only at a vertex,
/// all faces of the vertex are kept.
/// @param input   with faces
/// @param source  its face is numbered as in `input`
/// @throws InvalidArgument (no face is within that distance)
Surroundings surroundings(const io::Geometry& input, double radius, const SourceSpec& source);

/// Removes all faces except the kept ones. @param kept  ascending
/// @return number of vertices that only removed faces use
std::int64_t keep_faces(io::Geometry& input, const std::vector<Index>& kept);
void keep_faces(RepairedMesh& mesh, const std::vector<Index>& kept);

}  // namespace ahm::app
