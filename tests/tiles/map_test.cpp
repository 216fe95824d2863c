// Maps over tiles have the bits of the marched map in memory, for every limit of the memory.
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

void expect_same_map(const TiledCloud& cloud, const Surface& surface, Row row, Variant variant, double radius) {
  const Vertex vertex = surface.rows().vertex(row).value();
  const LogMap expected = LogMapSolver(surface.graph(), {.variant = variant, .strategy = Strategy::march})
                              .solve(Source::at_vertex(vertex), {.radius = radius});
  for (std::size_t memory : {std::size_t{1} << 16, std::size_t{1} << 30}) {
    const TiledGraph graph = cloud.graph(memory);
    ASSERT_EQ(graph.vertex_of_row(row), vertex);
    const auto summary = write_log_map(graph, Source::at_vertex(vertex), cloud.file("map"),
                                       {.heat = {.variant = variant}, .radius = radius, .memory = memory});
    EXPECT_EQ(summary.march.bands, expected.march().bands);
    EXPECT_EQ(summary.ok, expected.count(Status::ok));
    EXPECT_EQ(summary.releases > 0, memory < 1 << 20);
    EXPECT_EQ(summary.spills > 0, memory < 1 << 20);
    const MapArrays found(graph, cloud.file("map"));
    EXPECT_TRUE(same_bits<double>(found.coordinates, expected.coordinates()));
    EXPECT_TRUE(same_bits<double>(found.distance, expected.distances()));
    EXPECT_TRUE(same_bits<double>(found.spread, expected.spread()));
    EXPECT_TRUE(std::ranges::equal(found.status, expected.status()));
  }
}

/// A row of tile 2 whose one-ring extends to other tiles.
Row row_at_border(const TiledGraph& graph) {
  Index vertex = graph.first_vertex(2);
  const auto leaves_tile = [&](Index j) { return graph.tile_of(j) != 2; };
  while (std::ranges::none_of(graph.star(vertex).neighbors, leaves_tile)) ++vertex;
  const auto rows = graph.rows(2);
  return Row(rows.rows[rows.begin[vertex - graph.first_vertex(2)]]);
}

TEST(TiledLogMap, HasTheBitsOfTheMapInMemory) {
  const TiledCloud cloud(two_hills(130, 60), {.tile_points = 1500});
  const auto surface = cloud.surface();
  const Row center(130 * 65 + 65);
  expect_same_map(cloud, surface, Row(0), Variant::adaptive, everything);
  expect_same_map(cloud, surface, center, Variant::localized, everything);
  expect_same_map(cloud, surface, center, Variant::adaptive, 40);
  expect_same_map(cloud, surface, row_at_border(cloud.graph()), Variant::adaptive, everything);
}

TEST(TiledLogMap, HasTheBitsOfTheMapInMemoryWithReflections) {
  const TiledCloud cloud(moebius_cloud(12'000).points, {.tile_points = 1500});
  expect_same_map(cloud, cloud.surface(), Row(7), Variant::adaptive, everything);
}

/// Without coordinates a map stores the distances of the localized variant, whatever `variant` is, and nothing else.
TEST(TiledLogMap, WithoutCoordinatesHasTheDistancesOfTheLocalizedVariant) {
  const TiledCloud cloud(two_hills(70, 40), {.tile_points = 600});
  const TiledGraph graph = cloud.graph();
  const Vertex vertices[] = {graph.vertex_of_row(Row(11)).value(), graph.vertex_of_row(Row(70 * 35)).value()};
  const Source source = Source::at_vertices(vertices);
  const auto folder = cloud.file("map"), distances = cloud.file("distances"), csv = cloud.file("distances.csv");
  for (double radius : {everything, 20.0})
    for (std::size_t memory : {std::size_t{1} << 14, std::size_t{1} << 30}) {
      tiles::TiledMapOptions options{.radius = radius, .memory = memory};
      options.heat.variant = Variant::localized;
      const auto expected = write_log_map(graph, source, folder, options);
      options.coordinates = false;
      options.heat.variant = Variant::adaptive;
      const auto found = write_log_map(graph, source, distances, options);
      EXPECT_EQ(found.ok, expected.ok);
      EXPECT_EQ(found.farthest, expected.farthest);
      EXPECT_EQ(found.march.solved, expected.march.solved);
      const MapArrays a(graph, folder), b(graph, distances, false);
      EXPECT_TRUE(same_bits<double>(a.distance, b.distance));
      EXPECT_EQ(a.status, b.status);
      for (std::size_t t = 0; t < graph.tiles(); ++t)
        EXPECT_FALSE(map_file(distances, t).has("coordinates") || map_file(distances, t).has("spread"));
      expect_error<IoError>([&] { map_file(distances, 0).get<double>("coordinates"); }, "'coordinates'");
    }
  write_rows(graph, distances, csv);
  std::map<int, std::string> rows = csv_rows(csv, "row,distance,status");
  EXPECT_EQ(rows[11], ",0,ok");
  EXPECT_EQ(rows.size(), cloud.points.size());
}

/// Distances of the map may be below the straight-line distance to the source. Rows of tiles and of surfaces are raised to
/// it; those that are raised beyond the radius have no map.
TEST(TiledLogMap, HasTheRowsOfTheSurface) {
  const TiledCloud cloud(hills(60), {.tile_points = 1000});
  const auto surface = cloud.surface();
  const TiledGraph graph = cloud.graph();
  const Source source = Source::at_vertex(surface.rows().vertex(Row(0)).value());
  const LogMapSolver solver(surface.graph(), {.strategy = Strategy::march});
  const LogMap map = solver.solve(source);
  const RowLogMap expected = surface.to_rows(map);
  const auto csv = cloud.file("map.csv");
  const auto rows_of = [&](double radius, bool coordinates) {
    const auto ok = write_log_map(graph, source, cloud.file("map"), {.radius = radius, .coordinates = coordinates}).ok;
    write_rows(graph, cloud.file("map"), csv);
    return ok;
  };
  rows_of(everything, true);
  std::size_t raised = 0;
  const auto rise = [&](std::size_t r) { return expected.distance[r] - map.distance(*expected.vertex[r]); };
  for (const auto& [row, line] : csv_rows(csv, "row,u,v,distance,spread,status")) {
    const auto r = static_cast<std::size_t>(row);
    const std::vector<double> found = numbers_of(line);
    ASSERT_EQ(found.size(), 4u) << line;
    EXPECT_EQ(found[0], expected.u[r]);
    EXPECT_EQ(found[1], expected.v[r]);
    EXPECT_NEAR(found[2], expected.distance[r], 1e-13 * 85) << row;
    if (rise(r) > rise(raised)) raised = r;
  }
  ASSERT_GT(rise(raised), 1e-6);

  const double radius = expected.distance[raised] - 0.5 * rise(raised);
  const RowLogMap bounded = surface.to_rows(solver.solve(source, {.radius = radius}));
  ASSERT_EQ(bounded.status[raised], Status::beyond_radius);
  EXPECT_GT(rows_of(radius, true), std::count(bounded.status.begin(), bounded.status.end(), Status::ok));
  for (const auto& [row, line] : csv_rows(csv, "row,u,v,distance,spread,status"))
    EXPECT_TRUE(line.ends_with("," + std::string(to_string(bounded.status[static_cast<std::size_t>(row)])))) << line;
  rows_of(radius, false);
  for (const auto& [row, line] : csv_rows(csv, "row,distance,status")) {
    const bool ok = line.ends_with(",ok");
    EXPECT_EQ(ok, line != ",,beyond_radius") << line;
    EXPECT_TRUE(!ok || std::stod(line.substr(1)) <= radius) << line;
  }
}

TEST(TiledLogMap, IsWrittenAsRowsOfTheInput) {
  std::vector<Vec3> points = hills(60);
  const Row duplicate(static_cast<Index>(points.size())), stray(duplicate.index + 1);
  points.push_back(points[77]);
  points.push_back({0, 0, 5000});
  const TiledCloud cloud(points, {.tile_points = 1000});
  const TiledGraph graph = cloud.graph();
  const auto folder = cloud.file("map"), csv = cloud.file("map.csv");
  expect_error<IoError>([&] { write_rows(graph, folder, csv); }, "not finished");
  write_log_map(graph, Source::at_vertex(graph.vertex_of_row(Row(77)).value()), folder, {});
  write_rows(graph, folder, csv);
  std::map<int, std::string> rows = csv_rows(csv, "row,u,v,distance,spread,status");
  EXPECT_EQ(rows.size(), points.size());
  EXPECT_EQ(numbers_of(rows[77])[2], 0);
  EXPECT_TRUE(rows[77].ends_with(",ok"));
  EXPECT_EQ(rows[duplicate.index], rows[77]);
  EXPECT_EQ(rows[stray.index], ",,,,,removed");
  EXPECT_EQ(graph.vertex_of_row(stray), std::nullopt);
  EXPECT_THROW(graph.vertex_of_row(Row(stray.index + 1)), InvalidArgument);
  EXPECT_EQ(graph.nearest_vertex(points[77]), graph.vertex_of_row(Row(77)));
  const Row many[] = {Row(77), stray, Row(5), Row(77), duplicate};
  const auto found = graph.vertices_of_rows(many);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k], graph.vertex_of_row(many[k]));
}

}  // namespace
}  // namespace ahm::test
