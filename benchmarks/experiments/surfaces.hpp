/// \file
/// The surfaces of the experiments: generated ones, and the user's meshes.
///
/// \code
/// for (const NamedMesh& mesh : user_meshes(settings)) use(mesh.name, mesh.positions, mesh.faces);
/// \endcode
#pragma once

#include <functional>
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
struct NamedCloud {
  std::vector<Vec3> positions;
  std::string name;
};

/// Runs `work`. If it throws an `Error`, reports `name` on the error stream as left out.
void run_or_leave_out(const std::string& name, const std::function<void()>& work);

/// Triangle meshes and meshes of other polygons.
struct UserSurfaces {
  std::vector<NamedMesh> triangles;
  std::vector<NamedPolygons> polygons;
};
/// The meshes in `settings.meshes` and its subfolders with at most `largest` vertices, sorted by file size, also those
/// compressed with gzip. Files that cannot be read are reported on the error stream and left out.
UserSurfaces user_surfaces(const Settings& settings, Index largest);
/// The .xyz clouds there, also those compressed with gzip.
std::vector<NamedCloud> user_clouds(const Settings& settings, Index largest);
/// The triangle meshes only. Meshes of other polygons are reported, too.
std::vector<NamedMesh> user_meshes(const Settings& settings, Index largest = 1'000'000'000);

/// A sphere of meridians and parallels; few parallels make long thin triangles. `last` < pi leaves it open at the bottom.
Mesh parallels_and_meridians(int parallels, int meridians, double last = std::numbers::pi);
/// An icosphere with an additional vertex in each face, close to a side: caps and needles.
Mesh with_needles(Index n);
/// An icosphere whose points are moved along the sphere by up to `amount` edge lengths.
Mesh jittered_icosphere(Index n, double amount);
/// An icosphere of 642 vertices with random points inserted into random faces, n vertices in all: triangles of every shape.
Mesh sliver_sphere(Index n);
/// An icosphere stretched along the z axis and projected to the sphere: triangles up to `factor` times as long as wide.
Mesh stretched_icosphere(Index n, double factor);
/// An ellipsoid of half axes 1, 1, 2.
Mesh ellipsoid(Index n);
/// A sphere with smooth bumps, a few across.
Mesh bumpy_sphere(Index n);
/// An open cone of total angle `angle` and slant 1, with an inner vertex at the apex and jittered rings.
Mesh cone(double angle, int rings);
/// Two cones joined at their rims: closed, with a sharp edge around.
Mesh closed_cone(double angle, int rings);
/// An open tube of this radius about the x axis, of length 2. Its quads are as square as possible.
Mesh tube(int around, double radius);

}  // namespace ahm::bench
