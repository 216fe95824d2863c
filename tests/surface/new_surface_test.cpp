// A new kind of surface: a lattice of squares that implements only the required functions.
#include <gtest/gtest.h>

#include <cmath>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/graph/validate.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/surface/surface.hpp"
#include "surfaces.hpp"

namespace ahm::test {
namespace {

/// side x side points with spacing 1 in the plane z = 0. Neighbors are in the four directions of the axes.
class Lattice final : public Surface {
 public:
  explicit Lattice(Index side)
      : rows_(side * side, side * side, pairs(side)),
        graph_(data(side)),
        mesh_(quads(side, side, Columns::open, [](Index y, Index x) {
          return Vec3{1.0 * x, 1.0 * y, 0};
        })) {}

  const TangentGraph& graph() const& override { return graph_; }
  const RowMap& rows() const override { return rows_; }
  std::span<const Vec3> positions() const override { return mesh_.positions; }
  FaceList faces() const override { return {mesh_.begin, mesh_.corners}; }
  std::span<const Index> corner_vertices() const override { return mesh_.corners; }
  Report report() const override { return {{"vertices", std::int64_t{graph_.size()}}}; }
  std::vector<Warning> warnings() const override { return {}; }

 private:
  static std::vector<RowVertex> pairs(Index side) {
    std::vector<RowVertex> result;
    for (Index i = 0; i < side * side; ++i) result.push_back({Row(i), Vertex(i)});
    return result;
  }

  static CsrGraphData data(Index side) {
    CsrGraphData g;
    g.row_begin = {0};
    for (Index y = 0; y < side; ++y)
      for (Index x = 0; x < side; ++x) {
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
          if (x + dx < 0 || x + dx >= side || y + dy < 0 || y + dy >= side) continue;
          const bool on_boundary = dx == 0 ? x == 0 || x + 1 == side : y == 0 || y + 1 == side;
          g.neighbors.push_back((y + dy) * side + x + dx);
          g.weights.push_back(on_boundary ? 0.5 : 1);
          g.logs.insert(g.logs.end(), {1.0 * dx, 1.0 * dy});
          g.transports.insert(g.transports.end(), {1, 0});
        }
        g.row_begin.push_back(static_cast<Offset>(g.neighbors.size()));
        g.masses.push_back((x == 0 || x + 1 == side ? 0.5 : 1) * (y == 0 || y + 1 == side ? 0.5 : 1));
        g.frames.push_back({{1.0 * x, 1.0 * y, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
      }
    return g;
  }

  RowMap rows_;
  CsrGraph graph_;
  Polygons mesh_;
};

TEST(NewSurface, InheritsSourcesSamplesAndRows) {
  const Lattice lattice(12);
  EXPECT_NO_THROW(validate(lattice.graph()));
  const LogMap map =
      LogMapSolver(lattice.graph()).solve(lattice.source(Row(14), Vec3{0, 1, 0}).source, {.frames = true});
  const RowLogMap rows = lattice.to_rows(map);
  for (Index r = 0; r < 144; ++r) {
    EXPECT_NEAR(rows.u[r], lattice.positions()[r][1] - 1, 1e-10);
    EXPECT_NEAR(rows.v[r], 2 - lattice.positions()[r][0], 1e-10);
  }
  EXPECT_EQ(lattice.normals()[7], (Vec3{0, 0, 1}));
  EXPECT_EQ(lattice.nearest_row({3.2, 4.1, 9}), Row(51));

  const ClosestPoint found = lattice.closest_point({3.25, 4.5, -2});
  EXPECT_NEAR(found.distance, 2, 1e-14);
  const Sample sample = lattice.at(map, found.point);
  EXPECT_NEAR(sample.u, 4.5 - 1, 1e-10);
  EXPECT_NEAR(sample.v, 2 - 3.25, 1e-10);
  const Sample on_edge = lattice.at(map, EdgePoint{Row(14), Row(26), 0.5});
  EXPECT_NEAR(on_edge.u, 0.5, 1e-10);
  const std::vector<Vec2> corners = lattice.to_corners(map);
  EXPECT_EQ(corners[2][0], rows.u[13]);

  const SurfaceSource between = lattice.source(TangentPoint{Row(14), {2.25, 1.5, 0}}, Vec3{1, 0, 0});
  const Sample origin = lattice.at(LogMapSolver(lattice.graph()).solve(between.source), Row(14));
  EXPECT_NEAR(origin.u, -0.25, 1e-10);
  EXPECT_NEAR(origin.v, -0.5, 1e-10);
  EXPECT_THROW(lattice.source(FacePoint{0, {1, 0, 0, 0}}), InvalidArgument);  // not implemented
}

}  // namespace
}  // namespace ahm::test
