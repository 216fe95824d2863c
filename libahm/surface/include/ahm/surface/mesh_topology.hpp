/// \file
/// Topology checks of the mesh backends, and their report.
#pragma once

#include <optional>
#include <vector>

#include "ahm/report.hpp"
#include "ahm/types.hpp"

namespace ahm {

/// Handling of edges with more than two faces and of vertices whose faces form several fans.
enum class NonManifold {
  error,  ///< throw an error that lists them
  /// Cut the mesh. All faces at such an edge get a boundary there, and every fan of faces gets its own copy of the vertex. Heat
  /// and geodesics do not cross a cut. Sheets that are connected nowhere else become separate components.
  split,
};

/// Results of the topology checks. Counts refer to input vertices, edges or faces, as named.
struct TopologyReport {
  Index vertices = 0;      ///< input vertices
  Index faces = 0;         ///< input faces
  Index unreferenced = 0;  ///< vertices that no face uses; the graph does not contain them
  Index reoriented = 0;    ///< faces reversed to agree with the majority of their component
  bool orientable = true;  ///< false: e.g. a Moebius band
  Index components = 0;    ///< connected components of the vertices, after splitting
  Index boundary_edges = 0;
  Index boundary_loops = 0;
  Index non_manifold_edges = 0;     ///< edges of more than two faces, cut by NonManifold::split
  Index non_manifold_vertices = 0;  ///< vertices of several fans, also at such edges, split by NonManifold::split
  Index added_vertices = 0;         ///< vertices added by splitting
  /// Edges and Euler characteristic are those of the mesh as built: after splitting, without unreferenced vertices.
  Offset edges = 0;
  Offset euler_characteristic = 0;  ///< vertices - edges + faces

  /// Number of handles of all components together; none where the mesh is not orientable.
  std::optional<Offset> genus() const {
    if (!orientable) return std::nullopt;
    return (2 * Offset{components} - euler_characteristic - boundary_loops) / 2;
  }
};

/// Invalid faces of a mesh, and the topology of the remaining faces.
struct MeshInspection {
  std::vector<Index> outside;     ///< faces with a vertex index out of range
  std::vector<Index> small;       ///< faces of fewer than three corners
  std::vector<Index> repeating;   ///< faces that use a vertex twice
  std::vector<Index> duplicates;  ///< faces that repeat a face with a smaller number
  TopologyReport topology;  ///< topology of the remaining faces, cut where nonmanifold; zeros where no face remains
};

/// Inspects any mesh, including one that cannot be built. `faces.begin` must rise from 0 to the number of corners.
/// @throws InvalidGeometry (offsets)
MeshInspection inspect_mesh(Index vertices, const FaceList& faces);

/// Parts and orientations of faces, as a surface connects and orients them.
struct FaceParts {
  std::vector<Index> part;  ///< per face: the first face of its part, which is connected over edges of two faces
  std::vector<std::uint8_t> reversed;  ///< per face: 1 where it is reversed to agree with the majority of its part
};

/// Computes the parts and the orientations of the faces.
/// @throws InvalidGeometry (no faces; faces that no surface can be built from, as `MeshInspection` lists them)
FaceParts face_parts(Index vertices, const FaceList& faces);

/// The topology figures of a mesh's report: components, boundary_loops, orientable, reoriented, unreferenced,
/// non_manifold_edges, non_manifold_vertices, added_vertices.
Report figures(const TopologyReport& topology);

/// Warnings about a checked mesh. The number of each warning is the count of `TopologyReport` with this id: unreferenced,
/// reoriented, non_manifold_edges (cut), non_manifold_vertices (split; the second number is the count of added vertices),
/// not_orientable (no number), components (more than one).
std::vector<Warning> warnings(const TopologyReport& topology);

}  // namespace ahm
