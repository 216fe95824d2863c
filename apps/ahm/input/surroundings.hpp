/// \file
/// What --local left out, in the results of all of the input.
#pragma once

#include <vector>

#include "ahm/io/geometry.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/surface/mesh_topology.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "cli/options.hpp"

namespace ahm::app {

/// Some faces of a mesh, and what the others tell of them.
struct Surroundings {
  std::vector<Index> faces;  ///< ascending
  /// Of all faces, so that the surface of some is oriented like that of all; empty where no surface can be built of all.
  FaceParts whole;

  /// Of `faces`, those that the surface of all turns over.
  std::vector<std::uint8_t> turned() const;
  /// Per vertex the part of its last face, -1 where no face uses it.
  /// @param input  with all faces
  std::vector<Index> part_of_vertices(const io::Geometry& input) const;
};

/// The faces that come within one and a half radii of the source in a straight line, or of the vertex nearest to it where it
/// is a position: no path of the length of the radius comes farther than that, and half of it keeps the new boundary away.
/// Where they would meet at a vertex alone, all faces of the vertex are kept, too.
/// @param input   with faces
/// @param source  in its faces
/// @throws InvalidArgument where no face comes so near
Surroundings surroundings(const io::Geometry& input, double radius, const SourceSpec& source);

/// Leaves these faces alone. @param kept  ascending
/// @return how many vertices no face uses any more
std::int64_t keep_faces(io::Geometry& input, const std::vector<Index>& kept);
void keep_faces(RepairedMesh& mesh, const std::vector<Index>& kept);

}  // namespace ahm::app
