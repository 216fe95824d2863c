// A map over tiles is the marched map of the graph in memory, whatever memory the tiles may take.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_log_map.hpp"
#include "csv_lines.hpp"
#include "map_rows.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using tiles::ArrayFile;
using tiles::Manifest;
using tiles::TiledGraph;

void expect_same_map(const TiledCloud& cloud, Row row, Variant variant, double radius) {
  const auto surface = pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false});
  const Vertex vertex = surface.rows().vertex(row).value();
  const LogMap expected = LogMapSolver(surface.graph(), {.variant = variant, .strategy = Strategy::march})
                              .solve(Source::at_vertex(vertex), {.radius = radius});
  for (std::size_t memory : {std::size_t{1} << 16, std::size_t{1} << 30}) {
    const TiledGraph graph(cloud.tiles, memory);
    ASSERT_EQ(graph.vertex_of_row(row), vertex);
    tiles::TiledMapOptions options{.radius = radius, .memory = memory};
    options.heat.variant = variant;
    const auto folder = cloud.folder.directory() / "map";
    const auto summary = write_log_map(graph, Source::at_vertex(vertex), folder, options);
    EXPECT_EQ(summary.march.bands, expected.march().bands);
    EXPECT_EQ(summary.ok, expected.count(Status::ok));
    EXPECT_EQ(summary.releases > 0, memory < 1 << 20);
    EXPECT_EQ(summary.spills > 0, memory < 1 << 20);
    const MapRows rows(graph, folder);
    EXPECT_TRUE(same_bits<double>(rows.coordinates, expected.coordinates()));
    EXPECT_TRUE(same_bits<double>(rows.distance, expected.distances()));
    EXPECT_TRUE(same_bits<double>(rows.spread, expected.spread()));
    EXPECT_TRUE(std::equal(rows.status.begin(), rows.status.end(), expected.status().begin(), expected.status().end()));
  }
}

TEST(TiledLogMap, HasTheBitsOfTheMapInMemory) {
  const TiledCloud cloud(two_hills(130, 60), {.tile_points = 1500});
  cloud.build();
  const double everything = std::numeric_limits<double>::infinity();
  expect_same_map(cloud, Row(0), Variant::adaptive, everything);
  expect_same_map(cloud, Row(130 * 65 + 65), Variant::localized, everything);
  expect_same_map(cloud, Row(130 * 65 + 65), Variant::adaptive, 40);
}

/// Of distances alone: those of the localized map, to the bit, and nothing else on disk.
TEST(TiledLogMap, DistancesAloneAreThoseOfTheLocalizedMap) {
  const TiledCloud cloud(two_hills(70, 40), {.tile_points = 600});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const Vertex vertices[] = {graph.vertex_of_row(Row(11)).value(), graph.vertex_of_row(Row(70 * 35)).value()};
  const auto folder = cloud.folder.directory() / "map", alone = cloud.folder.directory() / "distance";
  for (double radius : {std::numeric_limits<double>::infinity(), 20.0})
    for (std::size_t memory : {std::size_t{1} << 14, std::size_t{1} << 30}) {
      tiles::TiledMapOptions options{.radius = radius, .memory = memory};
      options.heat.variant = Variant::localized;
      const auto expected = write_log_map(graph, Source::at_vertices(vertices), folder, options);
      options.coordinates = false;
      options.heat.variant = Variant::adaptive;  // means nothing then
      const auto found = write_log_map(graph, Source::at_vertices(vertices), alone, options);
      EXPECT_EQ(found.ok, expected.ok);
      EXPECT_EQ(found.farthest, expected.farthest);
      EXPECT_EQ(found.march.solved, expected.march.solved);
      for (std::size_t t = 0; t < graph.tiles(); ++t) {
        const ArrayFile a(Manifest::file(folder, "map", t), "map"), b(Manifest::file(alone, "map", t), "map");
        EXPECT_TRUE(test::same_bits(a.get<double>("distance"), b.get<double>("distance")));
        EXPECT_TRUE(test::same_bits(a.get<std::uint8_t>("status"), b.get<std::uint8_t>("status")));
        expect_error<IoError>([&] { b.get<double>("coordinates"); }, "no array 'coordinates'");
      }
    }
  const auto csv = cloud.folder.directory() / "distance.csv";
  write_rows(graph, alone, csv);
  std::map<int, std::string> rows = csv_lines(csv, "row,distance,status");
  EXPECT_EQ(rows[11], ",0,ok");
  EXPECT_EQ(rows.size(), cloud.points.size());
}

TEST(TiledLogMap, HasThemWithReflections) {
  TiledCloud cloud(moebius_cloud(12'000).points, {.tile_points = 1500});
  cloud.build();
  expect_same_map(cloud, Row(7), Variant::adaptive, std::numeric_limits<double>::infinity());
}

/// The source's own star is cut by the border of two tiles.
TEST(TiledLogMap, HasThemWhereABorderGoesThroughTheSource) {
  const TiledCloud cloud(two_hills(130, 60), {.tile_points = 1500});
  cloud.build();
  Row row(0);
  {
    const TiledGraph graph(cloud.tiles, 1 << 30);
    Index vertex = graph.first_vertex(2);
    const auto leaves = [&] {
      for (Index j : graph.star(vertex).neighbors)
        if (graph.tile_of(j) != 2) return true;
      return false;
    };
    while (!leaves()) ++vertex;
    const auto rows = graph.rows(2);
    row = Row(rows.rows[rows.begin[vertex - graph.first_vertex(2)]]);
  }
  expect_same_map(cloud, row, Variant::adaptive, std::numeric_limits<double>::infinity());
}

/// Heat alone may be below the straight line from the source, rows never are: as those of the surface in memory.
TEST(TiledLogMap, HasTheRowsOfTheSurface) {
  const TiledCloud cloud(hills(60), {.tile_points = 1000});
  cloud.build();
  const auto surface = pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false});
  const Vertex vertex = surface.rows().vertex(Row(0)).value();
  const LogMap map = LogMapSolver(surface.graph(), {.strategy = Strategy::march}).solve(Source::at_vertex(vertex));
  const RowLogMap expected = surface.to_rows(map);
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto folder = cloud.folder.directory() / "map", csv = cloud.folder.directory() / "map.csv";
  write_log_map(graph, Source::at_vertex(vertex), folder, {});
  write_rows(graph, folder, csv);
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  Index raised = 0;
  while (std::getline(file, line)) {
    int row = 0;
    double u = 0, v = 0, distance = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf,%lf,%lf", &row, &u, &v, &distance), 4) << line;
    const auto r = static_cast<std::size_t>(row);
    EXPECT_EQ(u, expected.u[r]);
    EXPECT_EQ(v, expected.v[r]);
    EXPECT_NEAR(distance, expected.distance[r], 1e-13 * 85) << row;
    if (distance > map.distance(*expected.vertex[r]) + 1e-6) ++raised;
  }
  EXPECT_GT(raised, 0);
}

/// Where the straight line raises a row beyond the radius it has none of the map.
TEST(TiledLogMap, HasTheRowsOfTheSurfaceAsFarAsTheRadius) {
  const TiledCloud cloud(hills(60), {.tile_points = 1000});
  cloud.build();
  const auto surface = pointcloud::PointCloudSurface::build(cloud.points, {}, {.parts_apart = false});
  const Source source = Source::at_vertex(surface.rows().vertex(Row(0)).value());
  const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march});
  const LogMap whole = solver.solve(source);
  const RowLogMap all = surface.to_rows(whole);
  std::size_t raised = 0;
  const auto gain = [&](std::size_t r) { return all.distance[r] - whole.distance(*all.vertex[r]); };
  for (std::size_t r = 0; r < all.distance.size(); ++r)
    if (gain(r) > gain(raised)) raised = r;
  ASSERT_GT(gain(raised), 1e-6);
  const double radius = all.distance[raised] - 0.5 * gain(raised);
  const RowLogMap expected = surface.to_rows(solver.solve(source, {.radius = radius}));
  ASSERT_EQ(expected.status[raised], Status::beyond_radius);

  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto folder = cloud.folder.directory() / "map", csv = cloud.folder.directory() / "map.csv";
  for (const bool coordinates : {true, false}) {
    tiles::TiledMapOptions options{.radius = radius, .coordinates = coordinates};
    const auto summary = write_log_map(graph, source, folder, options);
    write_rows(graph, folder, csv);
    if (!coordinates) break;  // those of the localized map
    EXPECT_GT(summary.ok, std::count(expected.status.begin(), expected.status.end(), Status::ok));
    for (const auto& [row, line] : csv_lines(csv, "row,u,v,distance,spread,status"))
      EXPECT_TRUE(line.ends_with("," + std::string(to_string(expected.status[static_cast<std::size_t>(row)])))) << line;
  }
  for (const auto& [row, line] : csv_lines(csv, "row,distance,status")) {
    const bool ok = line.ends_with(",ok");
    EXPECT_EQ(ok, line != ",,beyond_radius") << line;
    EXPECT_TRUE(!ok || std::stod(line.substr(1)) <= radius) << line;
  }
}

TEST(TiledLogMap, IsWrittenAsRowsOfTheInput) {
  std::vector<Vec3> points = hills(60);
  points.push_back(points[77]);
  points.push_back({0, 0, 5000});  // no vertex
  TiledCloud cloud(points, {.tile_points = 1000});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto folder = cloud.folder.directory() / "map", csv = cloud.folder.directory() / "map.csv";
  expect_error<IoError>([&] { write_rows(graph, folder, csv); }, "not finished");
  write_log_map(graph, Source::at_vertex(graph.vertex_of_row(Row(77)).value()), folder, {});
  write_rows(graph, folder, csv);
  std::map<int, std::string> rows = csv_lines(csv, "row,u,v,distance,spread,status");
  EXPECT_EQ(rows.size(), points.size());
  EXPECT_NE(rows[77].find(",0,"), std::string::npos) << rows[77];  // the distance
  EXPECT_TRUE(rows[77].ends_with(",ok"));
  EXPECT_EQ(rows[60 * 60], rows[77]);
  EXPECT_EQ(rows[60 * 60 + 1], ",,,,,removed");
  EXPECT_EQ(graph.vertex_of_row(Row(60 * 60 + 1)), std::nullopt);
  EXPECT_THROW(graph.vertex_of_row(Row(60 * 60 + 2)), InvalidArgument);
  EXPECT_EQ(graph.nearest_vertex(points[77]), graph.vertex_of_row(Row(77)));
  const Row many[] = {Row(77), Row(60 * 60 + 1), Row(5), Row(77), Row(60 * 60)};
  const auto found = graph.vertices_of_rows(many);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k], graph.vertex_of_row(many[k]));
}

}  // namespace
}  // namespace ahm::test
