// Maps of the tiles of a mesh are those of the mesh in memory, row for row.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

#include "ahm/conformance/polygon_meshes.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/error.hpp"
#include "ahm/maps/local_maps.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/polymesh/polygon_mesh_surface.hpp"
#include "ahm/surface/row_log_map.hpp"
#include "ahm/tiles/tile_surface.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "csv_lines.hpp"
#include "npy_column.hpp"
#include "ranks.hpp"
#include "said_by.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#ifndef AHM_MPI_PROGRAM
#define AHM_MPI_PROGRAM ""
#endif

namespace ahm::test {
namespace {

using polymesh::PolygonMeshSurface;
using tiles::Manifest;
using tiles::TiledGraph;
using trimesh::TriangleMeshSurface;

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// A surface and its tiles.
struct TiledSurface {
  TiledSurface(const Surface& given, Index tile_points) : surface(given) {
    tiles::tile_surface(surface, "mesh.ply", tiles, tile_points);
  }
  const Surface& surface;
  TemporaryFolder folder;
  std::filesystem::path tiles = folder.directory() / "tiles", map = folder.directory() / "map",
                        csv = folder.directory() / "map.csv";
};

std::vector<double> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream text(line.substr(1));
  for (std::string word; numbers.size() < 4 && std::getline(text, word, ',');)
    numbers.push_back(word.empty() ? NAN : std::stod(word));
  return numbers;
}

/// The file's u, v, distance, spread and status at every row are those of the surface, to the accuracy of the march; the spread,
/// which is a root of a difference of squares, to that of its square.
void expect_rows(const TiledSurface& tiled, const RowLogMap& expected) {
  const auto lines = csv_lines(tiled.csv, "row,u,v,distance,spread,status");
  ASSERT_EQ(lines.size(), expected.u.size());
  double farthest = 0, worst = 0, worst_square = 0;
  for (double r : expected.distance) farthest = std::max(farthest, std::isnan(r) ? 0 : r);
  int ok = 0;
  for (const auto& [row, line] : lines) {
    const auto i = static_cast<std::size_t>(row);
    ASSERT_EQ(line.substr(line.rfind(',') + 1), to_string(expected.status[i])) << "row " << row;
    if (expected.status[i] != Status::ok) continue;
    const std::vector<double> found = numbers_of(line);
    for (const double difference :
         {found[0] - expected.u[i], found[1] - expected.v[i], found[2] - expected.distance[i]}) {
      ASSERT_TRUE(std::isfinite(difference)) << "row " << row;
      worst = std::max(worst, std::abs(difference));
    }
    worst_square = std::max(worst_square, std::abs(found[3] * found[3] - expected.spread[i] * expected.spread[i]));
    ++ok;
  }
  EXPECT_GT(ok, 1);
  EXPECT_LE(worst, 1e-9 * farthest);
  EXPECT_LE(worst_square, 1e-9 * farthest * farthest);
}

/// Maps from a row, of all variants; then by two ranks.
void expect_same_maps(const Surface& surface, Index tile_points, std::size_t least_tiles, Row row,
                      double radius = no_limit) {
  const TiledSurface tiled(surface, tile_points);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  EXPECT_GE(graph.tiles(), least_tiles);
  EXPECT_EQ(graph.size(), surface.graph().size());
  EXPECT_EQ(graph.edge_count(), surface.graph().edge_count());
  EXPECT_EQ(graph.length_unit(), surface.graph().length_unit());
  const Source source = Source::at_vertex(graph.vertex_of_row(row).value());
  const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march});
  const auto expected = [&](Variant variant) {
    return surface.to_rows(
        solver.solve(Source::at_vertex(surface.vertex(row)), {.variant = variant, .radius = radius, .spread = true}));
  };
  for (Variant variant : all_variants) {
    std::filesystem::remove_all(tiled.map);
    write_log_map(graph, source, tiled.map, {.heat = {.variant = variant}, .radius = radius});
    tiles::write_rows(graph, tiled.map, tiled.csv);
    expect_rows(tiled, expected(variant));
  }
  if (std::string(AHM_MPI_PROGRAM).empty()) return;
  std::filesystem::remove_all(tiled.map);
  std::vector<std::string> words{"-n",      "2",        AHM_MPI_PROGRAM,          "logmap", tiled.tiles, "-o",
                                 tiled.map, "--source", std::to_string(row.index)};
  if (std::isfinite(radius)) words.insert(words.end(), {"--radius", std::to_string(radius)});
  Ranks ranks(words, tiled.folder.directory() / "log");
  ASSERT_EQ(ranks.wait(), 0) << ranks.log();
  tiles::write_rows(graph, tiled.map, tiled.csv);
  expect_rows(tiled, expected(Variant::adaptive));
}

TEST(TiledSurface, OfASphereHasItsMaps) {
  const Mesh mesh = icosphere(20);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  ASSERT_TRUE(surface.graph().is_delaunay());
  expect_same_maps(surface, 600, 6, Row(7));
  expect_same_maps(surface, 100'000, 1, Row(7), 1.5);
}

/// More vertices than those whose distances are unfolded by midpoints.
TEST(TiledSurface, OfAFineTorusHasItsMaps) {
  const Mesh mesh = torus(12'000);
  expect_same_maps(TriangleMeshSurface::build(mesh.positions, mesh.faces), 2500, 5, Row(100));
}

/// Rows that no face uses, and a part of another scale.
TEST(TiledSurface, OfTwoPartsWithUnusedRowsHasItsMaps) {
  const Mesh one = torus(2000), other = icosphere(8);
  std::vector<Vec3> points{{9, 9, 9}};
  std::vector<Triangle> faces;
  const auto add = [&](const Mesh& mesh, double scale, double shift) {
    const auto first = static_cast<Index>(points.size());
    for (const Vec3& p : mesh.positions) points.push_back({scale * p[0] + shift, scale * p[1], scale * p[2]});
    for (const Triangle& f : mesh.faces) faces.push_back({first + f[0], first + f[1], first + f[2]});
    points.push_back({0, 0, 50});
  };
  add(one, 1, 0), add(other, 30, 100);
  const auto surface = TriangleMeshSurface::build(points, faces);
  expect_same_maps(surface, 500, 4, Row(1));
  expect_same_maps(surface, 500, 4, Row(static_cast<Index>(one.positions.size()) + 5));
  const TiledSurface tiled(surface, 500);
  EXPECT_EQ(Manifest::read(tiled.tiles).components, 2);
  EXPECT_FALSE(TiledGraph(tiled.tiles, 1 << 24).vertex_of_row(Row(0)).has_value());
}

TEST(TiledSurface, OfPolygonsHasItsMaps) {
  const Polygons mesh = dual_sphere(12);
  for (const auto how : {polymesh::Discretization::refined, polymesh::Discretization::polygons}) {
    polymesh::PolygonOptions options;
    options.discretization = how;
    const auto surface = PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners, options);
    expect_same_maps(surface, 800, 2, Row(3));
  }
}

TEST(TiledSurface, OfAMoebiusBandHasItsMaps) {  // reflections
  const Mesh mesh = moebius_mesh(120, 16);
  expect_same_maps(TriangleMeshSurface::build(mesh.positions, mesh.faces), 600, 3, Row(50));
}

TEST(TiledSurface, HasTheMapFromSeveralRowsAndTheDistancesAlone) {
  const Mesh mesh = torus(3000);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
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

  const auto distances = tiled.folder.directory() / "distances";
  write_log_map(graph, source, distances, {.coordinates = false});
  tiles::write_rows(graph, distances, tiled.csv);
  const RowLogMap localized = surface.to_rows(solver.solve(expected, {.variant = Variant::localized}));
  for (const auto& [row, line] : csv_lines(tiled.csv, "row,distance,status"))
    ASSERT_NEAR(std::stod(line.substr(1)), localized.distance[static_cast<std::size_t>(row)], 1e-9) << "row " << row;
}

/// Over rows alone, of which the vertices inside refined polygons have none.
TEST(TiledSurface, OfPolygonsHasMeansOfColumns) {
  const Polygons mesh = dual_sphere(6);
  const auto surface = PolygonMeshSurface::build(mesh.positions, mesh.begin, mesh.corners);
  ASSERT_GT(surface.graph().size(), mesh.vertices());
  const TiledSurface tiled(surface, 300);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  const auto column = tiled.folder.directory() / "ones.npy";
  write_column(column, std::vector<double>(mesh.positions.size(), 1.0));
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 0.5;
  options.features = {"mean:" + column.string()};
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(write_local_maps(graph, t, tiled.map, options));
    const tiles::ArrayFile file(Manifest::file(tiled.map, "local", t), "local");
    for (double mean : file.get<double>("mean")) ASSERT_NEAR(mean, 1, 1e-12);
  }
}

TEST(TiledSurface, HasTheFramesAndTheLocalMapsOfTheSurface) {
  const Mesh mesh = icosphere(16);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const TiledSurface tiled(surface, 700);
  const TiledGraph graph(tiled.tiles, 1 << 24);
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 0.3;
  std::vector<Vertex> all;
  for (Index i = 0; i < surface.graph().size(); ++i) all.emplace_back(i);
  const LocalMaps expected = local_maps(surface.graph(), all, options.maps);
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(write_local_maps(graph, t, tiled.map, options));
    const tiles::ArrayFile file(Manifest::file(tiled.map, "local", t), "local");
    const auto indptr = file.get<Offset>("indptr");
    const auto distances = file.get<double>("distances");
    for (Index i = graph.first_vertex(t); i < graph.first_vertex(t + 1); ++i) {
      const auto rows = graph.rows(t);
      const Index local = i - graph.first_vertex(t), v = surface.vertex(Row(rows.rows[rows.begin[local]])).index;
      const Frame frame = *graph.frame(i), in_memory = *surface.graph().frame(v);
      ASSERT_TRUE(frame.origin == in_memory.origin && frame.x == in_memory.x && frame.y == in_memory.y &&
                  frame.normal == in_memory.normal);
      std::vector<double> found(distances.begin() + indptr[local], distances.begin() + indptr[local + 1]),
          there(expected.distances.begin() + expected.indptr[v], expected.distances.begin() + expected.indptr[v + 1]);
      std::sort(found.begin(), found.end()), std::sort(there.begin(), there.end());
      ASSERT_EQ(found.size(), there.size());
      for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], there[k], 1e-6);
    }
  }
}

TEST(TiledSurface, RefusesWhatTilesCannotSay) {
  const Mesh mesh = icosphere(4);
  const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces);
  const TiledSurface tiled(surface, 100);
  expect_error<InvalidArgument>([&] { tiles::tile_surface(surface, "mesh.ply", tiled.tiles, 100); },
                                "already contains tiles");
  expect_error<InvalidArgument>([&] { tiles::tile_surface(surface, "mesh.ply", tiled.map, 10); }, "tile_points");
}

/// Three pages of 20 x 20 squares that meet along the z axis, and a fourth at its foot alone.
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

/// Its rows along the cuts have several vertices, of which the nearest tells.
TEST(TiledSurface, OfACutMeshHasItsMaps) {
  const Mesh mesh = book();
  for (const bool flips : {true, false}) {
    trimesh::MeshOptions options;
    options.non_manifold = NonManifold::split;
    options.intrinsic_delaunay = flips;
    const auto surface = TriangleMeshSurface::build(mesh.positions, mesh.faces, options);
    ASSERT_GT(surface.rows().vertices(Row(5)).size(), 1u);
    for (const Row row : {Row(5), Row(200), Row(700)}) expect_same_maps(surface, 300, 5, row);
  }
}

void write_off(const std::filesystem::path& name, const Mesh& mesh) {
  std::ofstream off(name);
  off.precision(17);
  off << "OFF\n" << mesh.positions.size() << ' ' << mesh.faces.size() << " 0\n";
  for (const Vec3& p : mesh.positions) off << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const Triangle& f : mesh.faces) off << "3 " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
}

TEST(TiledSurface, TakesTheOptionsOfMeshesAndTellsWarningsInWords) {
  const TemporaryFolder folder;
  Mesh mesh = book();
  mesh.positions.push_back({9, 9, 9});
  const auto file = folder.directory() / "book.off";
  write_off(file, mesh);
  const auto plan = [&](const std::string& name, const std::string& options, int status = 0) {
    return said_by(std::string(AHM_TILES_PROGRAM) + " plan " + file.string() + " -o " +
                       (folder.directory() / name).string() + " " + options,
                   status);
  };
  EXPECT_NE(plan("tiles", "", 1).find("cut the mesh there with --non-manifold split"), std::string::npos);
  const std::string said = plan("tiles", "--non-manifold split --threads 1");
  EXPECT_NE(said.find("1 vertex that no face uses was left out"), std::string::npos) << said;
  EXPECT_NE(said.find("edges with more than two faces were cut"), std::string::npos) << said;
  EXPECT_TRUE(TiledGraph(folder.directory() / "tiles", 1 << 24).is_delaunay());
  plan("unflipped", "--non-manifold split --no-flips");
  EXPECT_FALSE(TiledGraph(folder.directory() / "unflipped", 1 << 24).is_delaunay());
  std::ofstream(folder.directory() / "points.off") << "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string refused =
      said_by(std::string(AHM_TILES_PROGRAM) + " plan " + (folder.directory() / "points.off").string() + " -o " +
                  (folder.directory() / "none").string() + " --no-flips",
              1);
  EXPECT_NE(refused.find("--no-flips require a mesh"), std::string::npos) << refused;
}

TEST(TiledSurface, IsMadeByTheProgram) {
  const TemporaryFolder folder;
  const Mesh mesh = icosphere(8);
  const auto file = folder.directory() / "mesh.off", tiles = folder.directory() / "tiles",
             map = folder.directory() / "map", csv = folder.directory() / "map.csv";
  write_off(file, mesh);
  const std::string program = AHM_TILES_PROGRAM, plan = program + " plan " + file.string() + " -o " + tiles.string();
  for (const char* option : {" --k 60", " --drop-nan", " --ignore-normals"})
    EXPECT_NE(said_by(plan + option, 1).find("--ignore-normals require a point cloud"), std::string::npos) << option;
  EXPECT_NE(said_by(plan + " --tile-points 200").find("tile(s), built"), std::string::npos);
  said_by(program + " build " + tiles.string());
  said_by(program + " logmap " + tiles.string() + " -o " + map.string() + " --source 0");
  said_by(program + " rows " + tiles.string() + " " + map.string() + " -o " + csv.string());
  EXPECT_NE(
      said_by(program + " rows " + tiles.string() + " " + map.string() + " -o " + (tiles / "manifest.json").string(), 1)
          .find("is in a folder"),
      std::string::npos);
  EXPECT_EQ(csv_lines(csv, "row,u,v,distance,spread,status").size(), mesh.positions.size());
  std::ofstream(folder.directory() / "cloud.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_NE(said_by(program + " plan " + (folder.directory() / "cloud.obj").string() + " -o " + map.string() + "2", 1)
                .find("has no faces"),
            std::string::npos);
}

}  // namespace
}  // namespace ahm::test
