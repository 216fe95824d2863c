// Refined meshes, and distances on them by windows on the coarse mesh, compared with windows on the fine mesh.
#include "tool_path/front.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ahm/conformance/parts.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/vec.hpp"
#include "part_surface.hpp"

namespace ahm::test {
namespace {

using detail::Half;

constexpr double infinity = std::numeric_limits<double>::infinity();

FaceMesh face_mesh_of(const Mesh& mesh) { return face_mesh(surface_of(mesh)); }

double area(const FaceMesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.size(); ++f) sum += mesh.area(static_cast<Index>(f));
  return sum;
}

TEST(Refinement, KeepsPointsShapeAndGluing) {
  for (const Mesh& part : {box({4, 3, 1}), cylinder(3, false), holed_plate(), moebius_mesh(24, 3)}) {
    const FaceMesh coarse = face_mesh_of(part);
    const Refinement fine = refined(coarse, 0.4);
    EXPECT_NEAR(area(fine.mesh), area(coarse), 1e-12 * area(coarse));
    for (std::size_t p = 0; p < coarse.points.size(); ++p) EXPECT_EQ(fine.mesh.points[p], coarse.points[p]);
    const FaceMesh again = glued(fine.mesh.points, fine.mesh.faces, fine.mesh.vertices);
    EXPECT_EQ(again.twin, fine.mesh.twin);
    EXPECT_EQ(again.mirrored, fine.mesh.mirrored);
    EXPECT_EQ(again.points.size(), fine.mesh.points.size());
    for (std::size_t h = 0; h < 3 * fine.mesh.size(); ++h) {
      const auto half = static_cast<Half>(h);
      const Vec3 a = fine.mesh.points[to_size(fine.mesh.tail(half))];
      EXPECT_LE(distance(a, fine.mesh.points[to_size(fine.mesh.head(half))]), 0.4);
      const Vec3 normal = normalized(coarse.area_normal(fine.parent[h / 3]));
      EXPECT_NEAR(dot(a - coarse.points[to_size(coarse.faces[to_size(fine.parent[h / 3])][0])], normal), 0, 1e-12);
      EXPECT_GT(dot(fine.mesh.area_normal(half / 3), normal), 0);
    }
  }
}

TEST(Refinement, DividesSidesIntoAsFewPartsAsPossible) {
  // A side of 5 / 4 of the limit has two parts, one of 9 / 4 three: powers of two would have four.
  const FaceMesh square = face_mesh_of(box({0.9, 0.9, 0.9}));
  EXPECT_EQ(refined(square, 1.3).mesh.size(), 12U);
  std::size_t on_axis = 0;
  for (const Vec3& p : refined(square, 0.4).mesh.points) on_axis += p[1] == 0 && p[2] == 0;
  EXPECT_EQ(on_axis, 4U);
}

TEST(Front, IsThatOfWindowsOnTheFineMesh) {
  for (const Mesh& part : {box({4, 3, 1}), cylinder(3, false), holed_plate(), icosphere(2), moebius_mesh(24, 3)}) {
    const PathDomain coarse(face_mesh_of(part));
    const FineDomain fine(coarse);
    std::vector<exact::MeshPoint> sources;
    for (const double share : {0.1, 0.3, 0.7, 0.9}) {
      const auto face = static_cast<Index>(share * static_cast<double>(fine.mesh.size()));
      sources.push_back({face, {0.5, 0.3, 0.2}});
    }
    sources.push_back(on_side(3 * (fine.mesh.size() / 2), 0.25));
    const Front found = front(fine, sources, infinity, {});
    const exact::ExactMap map = exact::exact_map(fine.surface, sources);
    std::size_t compared = 0;
    for (Index p = 0; p < fine.surface.vertex_count(); ++p) {
      EXPECT_NEAR(found.distance[to_size(p)], map.distance(Vertex(p)), 1e-11);
      const exact::Arrival& arrival = map.arrival(Vertex(p));
      if (arrival.half < 0 || std::isnan(found.back[to_size(p)])) continue;
      // The same direction, except where two shortest paths meet.
      const exact::HalfRecord side = fine.surface.record(arrival.half);
      const Vec2 apex{side.apex_x, side.apex_y}, to_origin = arrival.from - apex;
      const double back = fine.surface.turned({detail::previous(arrival.half), true}) +
                          std::atan2(ahm::cross(-apex, to_origin), ahm::dot(-apex, to_origin));
      compared += std::abs(std::remainder(found.back[to_size(p)] - back, fine.surface.angle_sum(p))) < 1e-9;
    }
    EXPECT_GT(compared, 0.98 * fine.surface.vertex_count());
  }
}

}  // namespace
}  // namespace ahm::test
