/// \file
/// What the backends for meshes check, and what they tell about it.
#pragma once

#include <optional>
#include <vector>

#include "ahm/report.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// What to do with edges of more than two faces and with vertices whose faces form several fans.
enum class NonManifold {
  error,  ///< throw, naming them
  /// Cut: all faces at such an edge become boundary faces there, and every fan of faces gets its own copy of the
  /// vertex. Heat and geodesics do not cross a cut; sheets that hang together nowhere else become separate components.
  split,
};

/// What the checks found. Counts are of input vertices, edges or faces as named.
struct TopologyReport {
  Index vertices = 0;      ///< input vertices
  Index faces = 0;         ///< input faces
  Index unreferenced = 0;  ///< vertices that no face uses; they are no vertices of the graph
  Index reoriented = 0;    ///< faces turned over to agree with the majority of their component
  bool orientable = true;  ///< false: e.g. a Moebius band
  Index components = 0;    ///< connected components (of vertices, after splitting)
  Index boundary_edges = 0;
  Index boundary_loops = 0;
  Index non_manifold_edges = 0;  ///< cut (NonManifold::split)
  Index non_manifold_vertices =
      0;                     ///< that join several fans of faces, those at such edges too; split (NonManifold::split)
  Index added_vertices = 0;  ///< by splitting them
  /// Of the mesh as it is built (after splitting, without unreferenced vertices).
  Offset edges = 0;
  Offset euler_characteristic = 0;  ///< vertices - edges + faces

  /// Handles of all components together; none where the mesh is not orientable.
  std::optional<Offset> genus() const {
    if (!orientable) return std::nullopt;
    return (2 * Offset{components} - euler_characteristic - boundary_loops) / 2;
  }
};

/// What is wrong with the faces of a mesh, and the topology of the others.
struct MeshInspection {
  std::vector<Index> outside;     ///< faces with a vertex that there is not
  std::vector<Index> small;       ///< of fewer than three corners
  std::vector<Index> repeating;   ///< that use a vertex twice
  std::vector<Index> duplicates;  ///< of faces with smaller numbers
  TopologyReport topology;        ///< of what is left, cut where it is no manifold; zeros where nothing is left
};

/// Looks at any mesh, also at one that cannot be built. `face.begin` must rise from 0 to the number of corners.
/// @throws InvalidGeometry (offsets)
MeshInspection inspect_mesh(Index vertices, const FaceList& faces);

/// How a surface of some faces joins and turns them.
struct FaceParts {
  std::vector<Index> part;  ///< per face, the first of those that it hangs together with over edges of two faces
  std::vector<std::uint8_t> reversed;  ///< per face, 1 where it is turned over to agree with the majority of its part
};

/// @throws InvalidGeometry (no faces; faces that no surface is built of, as `MeshInspection` lists them)
FaceParts face_parts(Index vertices, const FaceList& faces);

/// components, boundary_loops, orientable, reoriented, unreferenced, non_manifold_edges, non_manifold_vertices,
/// added_vertices: the figures of a mesh's report that are about its topology.
Report figures(const TopologyReport& topology);

/// What a user should know about a checked mesh. Ids, each with the count of `TopologyReport` as its number: unreferenced,
/// reoriented, non_manifold_edges (cut), non_manifold_vertices (split; and how many were added), not_orientable (no number), components (of more
/// than one).
std::vector<Warning> warnings(const TopologyReport& topology);

}  // namespace ahm
