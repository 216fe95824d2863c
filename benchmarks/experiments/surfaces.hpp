/// \file
/// The surfaces of the experiments: generated ones, and those of the user.
///
/// \code
/// for (const NamedMesh& mesh : user_meshes(settings)) use(mesh.name, mesh.positions, mesh.faces);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "ahm/conformance/polygon_meshes.hpp"
#include "experiments/experiment.hpp"
#include "shapes.hpp"

namespace ahm::bench {

struct NamedMesh : Mesh {
  std::string name;
};
struct NamedPolygons : test::Polygons {
  std::string name;
};

/// Every triangle mesh of the folder `settings.meshes` and below, by size of file, that has at most `largest` vertices.
/// What cannot be read, or has other polygons, is named on the error stream and left out.
std::vector<NamedMesh> user_meshes(const Settings& settings, Index largest = 1'000'000'000);
/// Every other mesh there, of polygons.
std::vector<NamedPolygons> user_polygons(const Settings& settings, Index largest);

/// Sphere by meridians and parallels; few parallels make long thin triangles. `last` < pi leaves it open at the bottom.
Mesh parallels_and_meridians(int parallels, int meridians, double last = std::numbers::pi);
/// Icosphere whose faces got one more vertex each, close to a side: caps and needles.
Mesh with_needles(Index n);
/// Icosphere whose points were moved along the sphere by up to `amount` edge lengths.
Mesh jittered_icosphere(Index n, double amount);
/// Icosphere of 642 vertices with random points put into random faces, n in all: triangles of every shape.
Mesh sliver_sphere(Index n);
/// Icosphere stretched along the z axis and pulled back to the sphere: triangles up to `factor` times as long as wide.
Mesh stretched_icosphere(Index n, double factor);
/// Ellipsoid of half axes 1, 1, 2.
Mesh ellipsoid(Index n);
/// Sphere with smooth bumps, a few across.
Mesh bumpy_sphere(Index n);
/// Open cone of the given total angle and slant 1, its apex inside, in jittered rings.
Mesh cone(double angle, int rings);
/// Two of them, rim to rim: closed, with a sharp edge around.
Mesh closed_cone(double angle, int rings);
/// Open tube of the given radius about the x axis and length 2, its quads as square as can be.
Mesh tube(int around, double radius);

}  // namespace ahm::bench
