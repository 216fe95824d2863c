// Maps of the tiles of a mesh equal those of the mesh in memory, row by row.
#include <cmath>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "ahm/tiles/tile_surface.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "programs.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using polymesh::PolygonMeshSurface;
using trimesh::TriangleMeshSurface;

TriangleMeshSurface build(const Mesh& mesh, const trimesh::MeshOptions& options = {}) {
  return TriangleMeshSurface::build(mesh.positions, mesh.faces, options);
}

/// A surface and its tiles.
struct TiledSurface {
  TiledSurface(const Surface& in_memory, Index tile_points) : surface(in_memory) {
    tiles::tile_surface(surface, "mesh.ply", tiles, tile_points);
  }
  const Surface& surface;
  TemporaryFolder folder;
  path tiles = folder.directory() / "tiles", map = folder.directory() / "map", csv = folder.directory() / "map.csv";
};

/// Compares u, v, distance, spread and status of all rows, to the accuracy of the march. The spread is the root of a difference
/// of squares, so its squares are compared.
void expect_rows(const TiledSurface& tiled, const RowLogMap& expected) {
  const auto lines = csv_rows(tiled.csv, "row,u,v,distance,spread,status");
  ASSERT_EQ(lines.size(), expected.u.size());
  double farthest = 0;
  for (double r : expected.distance) farthest = std::max(farthest, std::isnan(r) ? 0 : r);
  int ok = 0;
  for (const auto& [row, line] : lines) {
    const auto i = static_cast<std::size_t>(row);
    ASSERT_EQ(line.substr(line.rfind(',') + 1), to_string(expected.status[i])) << "row " << row;
    if (expected.status[i] != Status::ok) continue;
    const std::vector<double> found = numbers_of(line);
    ASSERT_NEAR(found[0], expected.u[i], 1e-9 * farthest) << "row " << row;
    ASSERT_NEAR(found[1], expected.v[i], 1e-9 * farthest) << "row " << row;
    ASSERT_NEAR(found[2], expected.distance[i], 1e-9 * farthest) << "row " << row;
    ASSERT_NEAR(found[3] * found[3], expected.spread[i] * expected.spread[i], 1e-9 * farthest * farthest) << row;
    ++ok;
  }
  EXPECT_GT(ok, 1);
}

/// Compares maps of all variants, and a map by two ranks.
void expect_same_maps(const Surface& surface, Index tile_points, std::size_t least_tiles, Row row,
                      double radius = everything) {
  const TiledSurface tiled(surface, tile_points);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  EXPECT_GE(graph.tiles(), least_tiles);
  EXPECT_EQ(graph.size(), surface.graph().size());
  EXPECT_EQ(graph.edge_count(), surface.graph().edge_count());
  EXPECT_EQ(graph.length_unit(), surface.graph().length_unit());
  const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march});
  const auto expect_variant = [&](Variant variant) {
    const auto map =
        solver.solve(Source::at_vertex(surface.vertex(row)), {.variant = variant, .radius = radius, .spread = true});
    tiles::write_rows(graph, tiled.map, tiled.csv);
    expect_rows(tiled, surface.to_rows(map));
    std::filesystem::remove_all(tiled.map);
  };
  for (Variant variant : all_variants) {
    write_log_map(graph, Source::at_vertex(graph.vertex_of_row(row).value()), tiled.map,
                  {.heat = {.variant = variant}, .radius = radius});
    expect_variant(variant);
  }
  if (std::string(AHM_MPI_PROGRAM).empty()) return;
  std::vector<std::string> words{"logmap", tiled.tiles, "-o", tiled.map, "--source", std::to_string(row.index)};
  if (std::isfinite(radius)) words.insert(words.end(), {"--radius", std::to_string(radius)});
  mpi_output(2, words, tiled.folder.directory() / "log");
  expect_variant(Variant::adaptive);
}

TEST(TiledSurface, HasTheMapsOfASphere) {
  const auto surface = build(icosphere(20));
  ASSERT_TRUE(surface.graph().is_delaunay());
  expect_same_maps(surface, 600, 6, Row(7));
  expect_same_maps(surface, 100'000, 1, Row(7), 1.5);
}

/// So many vertices that distances are not unfolded by midpoints.
TEST(TiledSurface, HasTheMapsOfAFineTorus) { expect_same_maps(build(torus(12'000)), 2500, 5, Row(100)); }

TEST(TiledSurface, HasTheMapsOfAMoebiusBand) { expect_same_maps(build(moebius_mesh(120, 16)), 600, 3, Row(50)); }

TEST(TiledSurface, HasTheMapsOfTwoComponentsWithUnusedRows) {
  const Mesh large = torus(2000), small = icosphere(8);
  Mesh both;
  both.positions = {{9, 9, 9}};
  const auto append = [&](const Mesh& mesh, double scale, double shift) {
    const auto first = static_cast<Index>(both.positions.size());
    for (const Vec3& p : mesh.positions) both.positions.push_back({scale * p[0] + shift, scale * p[1], scale * p[2]});
    for (const Triangle& f : mesh.faces) both.faces.push_back({first + f[0], first + f[1], first + f[2]});
    both.positions.push_back({0, 0, 50});
  };
  append(large, 1, 0), append(small, 30, 100);
  const auto surface = build(both);
  expect_same_maps(surface, 500, 4, Row(1));
  expect_same_maps(surface, 500, 4, Row(static_cast<Index>(large.positions.size()) + 5));
  const TiledSurface tiled(surface, 500);
  EXPECT_EQ(Manifest::read(tiled.tiles).components, 2);
  EXPECT_FALSE(TiledGraph(tiled.tiles, 1 << 24).vertex_of_row(Row(0)).has_value());
}

TEST(TiledSurface, HasTheMapsOfPolygons) {
  const Polygons mesh = dual_sphere(12);
  for (const auto discretization : {polymesh::Discretization::refined, polymesh::Discretization::polygons}) {
    polymesh::PolygonOptions options;
    options.discretization = discretization;
    expect_same_maps(PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, options), 800, 2, Row(3));
  }
}

TEST(TiledSurface, HasTheMapFromSeveralRowsAndItsDistances) {
  const auto surface = build(torus(3000));
  const TiledSurface tiled(surface, 500);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  std::vector<Vertex> in_tiles, in_memory;
  for (Index row : {3, 1500, 2900}) {
    in_tiles.push_back(graph.vertex_of_row(Row(row)).value());
    in_memory.push_back(surface.vertex(Row(row)));
  }
  const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march});
  const Source source = Source::at_vertices(in_tiles), expected = Source::at_vertices(in_memory);
  write_log_map(graph, source, tiled.map, {});
  tiles::write_rows(graph, tiled.map, tiled.csv);
  expect_rows(tiled, surface.to_rows(solver.solve(expected, {.spread = true})));

  const path distances = tiled.folder.directory() / "distances";
  write_log_map(graph, source, distances, {.coordinates = false});
  tiles::write_rows(graph, distances, tiled.csv);
  const RowLogMap localized = surface.to_rows(solver.solve(expected, {.variant = Variant::localized}));
  for (const auto& [row, line] : csv_rows(tiled.csv, "row,distance,status"))
    ASSERT_NEAR(std::stod(line.substr(1)), localized.distance[static_cast<std::size_t>(row)], 1e-9) << "row " << row;
}

/// Means are over rows. Vertices inside refined polygons have none.
TEST(TiledSurface, HasMeansOfColumnsOfPolygons) {
  const Polygons mesh = dual_sphere(6);
  const auto surface = PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
  ASSERT_GT(surface.graph().size(), mesh.vertices());
  const TiledSurface tiled(surface, 300);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  const path column = tiled.folder.directory() / "ones.npy";
  write_column(column, std::vector<double>(mesh.positions.size(), 1.0));
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(
        write_local_maps(graph, t, tiled.map, {.maps = {.radius = 0.5}, .features = {"mean:" + column.string()}}));
    const ArrayFile file = local_file(tiled.map, t);
    for (double mean : file.get<double>("mean")) ASSERT_NEAR(mean, 1, 1e-12);
  }
}

TEST(TiledSurface, HasTheFramesAndTheLocalMapsOfTheSurface) {
  const auto surface = build(icosphere(16));
  const TiledSurface tiled(surface, 700);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 0.3;
  const LocalMaps expected = local_maps(surface.graph(), options.maps);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(write_local_maps(graph, t, tiled.map, options));
    const ArrayFile file = local_file(tiled.map, t);
    const auto indptr = file.get<Offset>("indptr");
    const auto distances = file.get<double>("distances");
    const auto rows = graph.rows(t);
    for (Index i = graph.first_vertex(t); i < graph.first_vertex(t + 1); ++i) {
      const Index local = i - graph.first_vertex(t), v = surface.vertex(Row(rows.rows[rows.begin[local]])).index;
      const Frame frame = *graph.frame(i), in_memory = *surface.graph().frame(v);
      ASSERT_TRUE(frame.origin == in_memory.origin && frame.x == in_memory.x && frame.y == in_memory.y &&
                  frame.normal == in_memory.normal);
      std::vector<double> found(distances.begin() + indptr[local], distances.begin() + indptr[local + 1]),
          wanted(expected.distances.begin() + expected.indptr[v], expected.distances.begin() + expected.indptr[v + 1]);
      std::ranges::sort(found), std::ranges::sort(wanted);
      ASSERT_EQ(found.size(), wanted.size());
      for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], wanted[k], 1e-6);
    }
  }
}

TEST(TiledSurface, RefusesUsedFoldersAndSmallTiles) {
  const auto surface = build(icosphere(4));
  const TiledSurface tiled(surface, 100);
  const auto tile = [&](const path& folder, Index points) { tiles::tile_surface(surface, "mesh.ply", folder, points); };
  expect_error<InvalidArgument>([&] { tile(tiled.tiles, 100); }, "already contains tiles");
  expect_error<InvalidArgument>([&] { tile(tiled.map, 10); }, "tile_points");
}

/// Three pages of 20 x 20 squares that meet along the z axis. A fourth page meets them only at the end of this axis.
Mesh book() {
  Mesh mesh;
  constexpr Index side = 21;
  std::vector<Index> spine;
  for (int page = 0; page < 4; ++page) {
    const double angle = 2 * page, foot = page == 3 ? -1 : 0;
    std::vector<Index> at;
    for (Index i = 0; i < side; ++i)
      for (Index j = 0; j < side; ++j) {
        const bool is_shared = i == 0 && (page == 3 ? j == side - 1 : page > 0);
        at.push_back(is_shared ? spine[page == 3 ? 0 : j] : static_cast<Index>(mesh.positions.size()));
        if (!is_shared) mesh.positions.push_back({i * std::cos(angle) / 20, i * std::sin(angle) / 20, foot + j / 20.0});
        if (page == 0 && i == 0) spine.push_back(at.back());
      }
    for (Index i = 0; i + 1 < side; ++i)
      for (Index j = 0; j + 1 < side; ++j) {
        const Index a = at[i * side + j], b = at[(i + 1) * side + j];
        const Index c = at[(i + 1) * side + j + 1], d = at[i * side + j + 1];
        mesh.faces.push_back({a, b, c}), mesh.faces.push_back({a, c, d});
      }
  }
  return mesh;
}

/// Rows at cuts have several vertices. They get the map of the nearest.
TEST(TiledSurface, HasTheMapsOfACutMesh) {
  const Mesh mesh = book();
  for (const bool flips : {true, false}) {
    trimesh::MeshOptions options;
    options.non_manifold = NonManifold::split;
    options.intrinsic_delaunay = flips;
    const auto surface = build(mesh, options);
    ASSERT_GT(surface.rows().vertices(Row(5)).size(), 1u);
    for (const Row row : {Row(5), Row(200), Row(700)}) expect_same_maps(surface, 300, 5, row);
  }
}

/// ahm-tiles in a folder of its own.
class TilesProgramOnMeshes : public testing::Test {
 protected:
  void write_off(const std::string& name, const Mesh& mesh) const {
    std::ofstream off(file(name));
    off.precision(17);
    off << "OFF\n" << mesh.positions.size() << ' ' << mesh.faces.size() << " 0\n";
    for (const Vec3& p : mesh.positions) off << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (const Triangle& f : mesh.faces) off << "3 " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
  }
  path file(const std::string& name) const { return folder.directory() / name; }
  /// Runs ahm-tiles, which must exit with `status` and print `part`.
  void expect_output(const std::string& arguments, const std::string& part, int status = 0) const {
    const auto output = output_of("cd " + folder.directory().string() + "; " AHM_TILES_PROGRAM " " + arguments, status);
    EXPECT_NE(output.find(part), std::string::npos) << output;
  }

  const TemporaryFolder folder;
};

TEST_F(TilesProgramOnMeshes, HasOptionsOfMeshesAndPrintsWarnings) {
  Mesh mesh = book();
  mesh.positions.push_back({9, 9, 9});
  write_off("book.off", mesh);
  expect_output("plan book.off -o tiles", "--non-manifold split", 1);
  const std::string plan = "plan book.off --non-manifold split -o ";
  expect_output(plan + "tiles --threads 1", "1 vertex that no face uses was left out");
  expect_output(plan + "again", "edges with more than two faces were cut");
  expect_output(plan + "unflipped --no-flips", "");
  EXPECT_TRUE(TiledGraph(file("tiles"), 1 << 24).is_delaunay());
  EXPECT_FALSE(TiledGraph(file("unflipped"), 1 << 24).is_delaunay());
  write_file(file("points.off"), "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  expect_output("plan points.off -o none --no-flips", "--no-flips require a mesh", 1);
}

TEST_F(TilesProgramOnMeshes, MakesTilesMapsAndRows) {
  const Mesh mesh = icosphere(8);
  write_off("mesh.off", mesh);
  for (const std::string option : {"--k 60", "--drop-nan", "--ignore-normals"})
    expect_output("plan mesh.off -o tiles " + option, "--ignore-normals require a point cloud", 1);
  expect_output("plan mesh.off -o tiles --tile-points 200", "tiles, built");
  expect_output("build tiles", "");
  expect_output("logmap tiles -o map --source 0", "");
  expect_output("rows tiles map -o map.csv", "");
  expect_output("rows tiles map -o tiles/manifest.json", "is in a folder", 1);
  EXPECT_EQ(csv_rows(file("map.csv"), "row,u,v,distance,spread,status").size(), mesh.positions.size());
  write_file(file("cloud.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  expect_output("plan cloud.obj -o others", "has no faces", 1);
}

}  // namespace
}  // namespace ahm::test
