/// \file
/// Clouds and meshes, and their text as files.
#pragma once

#include <string>
#include <vector>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/types.hpp"

namespace ahm::test {

using Points = std::vector<Vec3>;
using Faces = std::vector<std::vector<int>>;

/// Points (and normals) with full precision.
std::string xyz(const Points& points, const Points& normals = {});

/// @param first  number of the mesh's first vertex in the file, from 1
std::string obj(const Points& positions, const Faces& faces, int first = 1);
std::string obj(const Mesh& mesh, int first = 1);
std::string obj(const Polygons& mesh);

/// A jittered plane z = 0 in [0, 1]^2 of m x m points. Point 0 is its middle.
Points plane(int m);

/// n points evenly on the unit sphere; point 0 is (0, 0, 1).
Points sphere(int n);

/// A lattice of m x m points in the plane z = 0, row by row. Waves of this height move points along their row.
Points lattice(int m, double spacing = 1, double wave = 0);

/// The cells of a lattice, row by row: quads, or two triangles each.
Faces cells(int m, bool triangles = false);

/// Triangles of a sheared lattice of m x m vertices in [0, 1] x [0, 0.1]. They are long and thin.
std::string sheet(int m);

/// A flat sheet of m x m positions in the unit square whose triangles share no vertices.
std::string torn_sheet(int m);

Points moved(Points points, const Vec3& by, double scale = 1);
Points joined(Points a, const Points& b);

/// Three flat pages of m x m vertices that share their spine. Each edge of the spine has three faces.
std::string book(int m);

/// A unit cube of quads, corner k at the bits of k; then a separate unit square, vertices 8 to 11 at (3, 0, 0) to (4, 1, 0).
inline constexpr const char* cube_and_square =
    "OFF\n12 7 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n3 0 0\n4 0 0\n4 1 0\n3 1 0\n"
    "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n4 8 9 10 11\n";

/// An ASCII PLY file. Properties are declared with their type: "float x".
std::string ply(const std::vector<std::string>& properties, std::size_t vertices, const std::string& vertex_lines,
                std::size_t faces = 0, const std::string& face_lines = {});

}  // namespace ahm::test
