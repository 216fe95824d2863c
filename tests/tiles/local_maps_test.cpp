// Local maps of tiles equal those of the whole graph. Features are computed from these maps.
#include "ahm/maps/local_maps.hpp"

#include <numbers>

#include "ahm/util/vec.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

/// The maps differ by at most `tolerance`, in units of the radius.
void expect_same_local_maps(const TiledCloud& cloud, double radius, Variant variant, double tolerance) {
  const auto folder = cloud.file("local");
  std::filesystem::remove_all(folder);
  const TiledGraph graph = cloud.graph();
  LocalMapOptions options{.radius = radius, .bound_by_straight_line = true};
  options.heat.variant = variant;
  const auto surface = cloud.surface();
  const LocalMaps expected = local_maps(surface.graph(), options);
  const auto entries_of = [&](const LocalMaps& maps, Index s) {
    std::map<Index, std::array<double, 5>> entries;
    for (Offset e = maps.indptr[s]; e < maps.indptr[s + 1]; ++e)
      entries[maps.neighbors[e].index] = {maps.logs[2 * e], maps.logs[2 * e + 1], maps.distances[e],
                                          radius * maps.transports[2 * e], radius * maps.transports[2 * e + 1]};
    return entries;
  };
  Index compared = 0;
  for (std::size_t t = 0; t < graph.tiles(); ++t) {
    ASSERT_TRUE(write_local_maps(graph, t, folder, {.maps = options}));
    const ArrayFile file = local_file(folder, t);
    LocalMaps maps;
    const auto read = [&]<class T>(std::vector<T>& into, const char* name) {
      const auto values = file.get<T>(name);
      into.assign(values.begin(), values.end());
    };
    read(maps.indptr, "indptr"), read(maps.neighbors, "neighbors"), read(maps.logs, "logs");
    read(maps.distances, "distances"), read(maps.transports, "transports");
    for (Index s = 0; s < maps.sources(); ++s) {
      const auto found = entries_of(maps, s), wanted = entries_of(expected, graph.first_vertex(t) + s);
      for (const auto& [vertex, values] : wanted) {
        const auto at = found.find(vertex);
        if (at == found.end()) {  // only at the radius
          ASSERT_GT(values[2], radius * (1 - tolerance));
          continue;
        }
        for (std::size_t c = 0; c < values.size(); ++c) ASSERT_NEAR(values[c], at->second[c], radius * tolerance);
        ++compared;
      }
      ASSERT_LE(found.size(), wanted.size() + 3);
    }
  }
  EXPECT_GT(compared, 20 * graph.size());
}

TEST(TiledLocalMaps, AreThoseOfTheWholeGraphOnPlanes) {
  const TiledCloud cloud(jittered_grid(70, 70, 1), {.tile_points = 1000});
  expect_same_local_maps(cloud, 4, Variant::adaptive, 1e-9);
  expect_same_local_maps(cloud, 4, Variant::localized, 1e-9);
}

TEST(TiledLocalMaps, AreThoseOfTheWholeGraphUpToTheMargin) {
  std::vector<Vec3> points = hills(60);
  for (const Vec3& p : hills(30, 3)) points.push_back({300 + 2 * p[0], 2 * p[1], p[2]});  // another edge length
  expect_same_local_maps(TiledCloud(points, {.tile_points = 1000}), 5, Variant::adaptive, 1e-3);
}

TEST(TiledLocalMaps, AreWrittenOnce) {
  const TiledCloud cloud(hills(30), {.tile_points = 2500});
  const TiledGraph graph = cloud.graph();
  const auto write = [&](std::size_t tile, double radius) {
    return write_local_maps(graph, tile, cloud.file("maps"), {.maps = {.radius = radius}});
  };
  EXPECT_TRUE(write(0, 2));
  EXPECT_FALSE(write(0, 2));
  expect_error<InvalidArgument>([&] { write(0, 3); }, "other options");
  expect_error<InvalidArgument>([&] { write(99, 2); }, "tile 99");
  expect_error<InvalidArgument>([&] { write_local_maps(graph, 0, cloud.file("maps"), {}); }, "radius");

  const auto write_mean = [&](const std::string& column) {
    return write_local_maps(graph, 0, cloud.file("means"),
                            {.maps = {.radius = 3}, .features = {"mean:" + cloud.file(column).string()}});
  };
  std::vector<double> values(900, 1.0);
  write_column(cloud.file("a.npy"), values), write_column(cloud.file("same.npy"), values);
  values[450] = 2;
  write_column(cloud.file("b.npy"), values);
  EXPECT_TRUE(write_mean("a.npy"));
  EXPECT_FALSE(write_mean("a.npy"));
  EXPECT_FALSE(write_mean("same.npy"));
  expect_error<InvalidArgument>([&] { write_mean("b.npy"); }, "other options");
}

/// Means are weighted by mass. If two rows have the same point, their mean is the value there.
TEST(LocalFeatures, AreCountsAreasAndMeansOfTheMaps) {
  std::vector<Vec3> points = hills(60);
  points.push_back(points[1830]);
  const TiledCloud cloud(points, {.tile_points = 1000});
  const TiledGraph graph = cloud.graph();
  std::vector<double> heights;
  for (const Vec3& p : points) heights.push_back(p[2]);
  heights.back() = 100;
  write_column(cloud.file("height.npy"), heights);
  write_column(cloud.file("constant.npy"), std::vector<double>(points.size(), 0.7));
  std::vector<double> height_at(static_cast<std::size_t>(graph.size()));
  for (std::size_t r = 0; r + 1 < points.size(); ++r)
    height_at[graph.vertex_of_row(Row(static_cast<Index>(r))).value().index] = heights[r];
  const Index twice = graph.vertex_of_row(Row(1830)).value().index;
  ASSERT_EQ(graph.vertex_of_row(Row(60 * 60)), Vertex(twice));
  height_at[twice] = (points[1830][2] + 100) / 2;

  const std::size_t tile = graph.tile_of(twice);
  write_local_maps(graph, tile, cloud.file("maps"), {.maps = {.radius = 3}});
  write_local_maps(graph, tile, cloud.file("features"),
                   {.maps = {.radius = 3},
                    .features = {"area", "count", "mean:" + cloud.file("height.npy").string(),
                                 "mean:" + cloud.file("constant.npy").string()}});
  const ArrayFile maps = local_file(cloud.file("maps"), tile), features = local_file(cloud.file("features"), tile);
  const auto indptr = maps.get<Offset>("indptr");
  const auto neighbors = maps.get<Index>("neighbors");
  const auto weights = maps.get<double>("weights");
  const auto count = features.get<Index>("count");
  const auto area = features.get<double>("area"), mean = features.get<double>("mean");
  ASSERT_GT(count.size(), 500u);
  ASSERT_EQ(count.size() + 1, indptr.size());
  ASSERT_EQ(mean.size(), 2 * count.size());
  for (std::size_t s = 0; s < count.size(); ++s) {
    EXPECT_EQ(count[s], indptr[s + 1] - indptr[s]);
    double mass = 0, sum = 0;
    for (Offset e = indptr[s]; e < indptr[s + 1]; ++e) mass += weights[e], sum += weights[e] * height_at[neighbors[e]];
    EXPECT_EQ(area[s], mass);
    EXPECT_NEAR(mean[2 * s], sum / mass, 1e-13 * 100);
    EXPECT_NEAR(mean[2 * s + 1], 0.7, 1e-14);
  }
}

/// Curvatures of all vertices, tile after tile.
struct Curvatures {
  Curvatures(const TiledCloud& cloud, double radius) {
    const TiledGraph graph = cloud.graph();
    for (std::size_t t = 0; t < graph.tiles(); ++t) {
      EXPECT_TRUE(
          write_local_maps(graph, t, cloud.file("curvature"), {.maps = {.radius = radius}, .features = {"curvature"}}));
      const ArrayFile file = local_file(cloud.file("curvature"), t);
      for (const Vec2& value : file.get<Vec2>("curvatures")) values.push_back(value);
      for (const Vec3& value : file.get<Vec3>("directions")) directions.push_back(value);
    }
    for (Index i = 0; i < graph.size(); ++i) positions.push_back(graph.frame(i)->origin);
    EXPECT_EQ(values.size(), positions.size());
    EXPECT_EQ(directions.size(), positions.size());
  }
  std::vector<Vec2> values;
  std::vector<Vec3> directions, positions;
};

/// Principal curvatures 1 / radius and `second` / radius, apart from the sign of the normal, for z in [low, high]. The height
/// of a circle over its arc length s is s^2 / 2r - s^4 / 24r^3. Within a distance R the second term changes the fit by at most
/// R^2 / 16 r^2 on spheres and R^2 / 12 r^2 on cylinders.
void expect_curvatures(const std::vector<Vec3>& points, double radius, double second, double low, double high) {
  const double reach = 4, tolerance = reach * reach / (12 * radius * radius);
  const Curvatures found(TiledCloud(points, {.tile_points = 1000}), reach);
  const double sign = found.values[0][0] > 0 ? 1 : -1;
  Index compared = 0;
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    if (found.positions[i][2] < low || found.positions[i][2] > high) continue;
    EXPECT_NEAR(sign * found.values[i][0] * radius, 1, tolerance);
    EXPECT_NEAR(sign * found.values[i][1] * radius, second, tolerance);
    EXPECT_GE(std::abs(found.values[i][0]), std::abs(found.values[i][1]));
    EXPECT_NEAR(norm(found.directions[i]), 1, 1e-12);
    if (second == 0) {  // around the z axis
      const double x = found.positions[i][0] / radius, y = found.positions[i][1] / radius;
      EXPECT_NEAR(std::abs(x * found.directions[i][1] - y * found.directions[i][0]), 1, tolerance);
    }
    ++compared;
  }
  EXPECT_GT(compared, 1500);
}

TEST(LocalFeatures, CurvaturesOfSpheresCylindersAndPlanesAreExact) {
  const double radius = 20;
  std::vector<Vec3> sphere = even_sphere(3000).points;
  for (Vec3& p : sphere) p = radius * p;
  expect_curvatures(sphere, radius, 1, -radius, radius);

  const auto columns = static_cast<Index>(2 * std::numbers::pi * radius);
  std::vector<Vec3> cylinder = jittered_grid(columns, 30, 5);
  for (Vec3& p : cylinder) {
    const double angle = p[0] * 2 * std::numbers::pi / columns;
    p = {radius * std::cos(angle), radius * std::sin(angle), p[1]};
  }
  expect_curvatures(cylinder, radius, 0, 4, 25);  // near the boundary the neighbors are on one side

  std::vector<Vec3> plane = hills(40);
  for (Vec3& p : plane) p[2] = 0.25 * p[0] - 0.5 * p[1] + 3;
  for (const Vec2& kappa : Curvatures(TiledCloud(plane, {.tile_points = 500}), 4).values)
    for (double value : kappa) EXPECT_NEAR(value, 0, 1e-9);
}

TEST(LocalFeatures, CurvatureIsNanWithoutNeighbors) {
  for (const Vec2& kappa : Curvatures(TiledCloud(hills(20)), 0.1).values) EXPECT_TRUE(std::isnan(kappa[0]));
}

/// A cloud that is rotated and twice as large has half the curvature along rotated directions. Compared row by row, because
/// the order of tiles does not rotate.
TEST(LocalFeatures, CurvatureRotatesAndScalesWithTheCloud) {
  const std::vector<Vec3> points = hills(40);
  std::vector<Vec3> rotated;
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto rotate = [&](const Vec3& p) { return Vec3{p[2], c * p[0] - s * p[1], s * p[0] + c * p[1]}; };
  for (const Vec3& p : points) rotated.push_back(2.0 * rotate(p));
  const TiledCloud cloud(points, {.tile_points = 700}), other_cloud(rotated, {.tile_points = 700});
  const TiledGraph graph = cloud.graph(), other_graph = other_cloud.graph();
  const Curvatures found(cloud, 4), other(other_cloud, 8);
  Index compared = 0;
  for (Index row = 0; row < 1600; row += 3) {
    const Index a = graph.vertex_of_row(Row(row)).value().index, b = other_graph.vertex_of_row(Row(row)).value().index;
    const double sign = dot(rotate(graph.frame(a)->normal), other_graph.frame(b)->normal);
    ASSERT_NEAR(std::abs(sign), 1, 1e-9);
    EXPECT_NEAR(2 * sign * other.values[b][0], found.values[a][0], 1e-6);
    EXPECT_NEAR(2 * sign * other.values[b][1], found.values[a][1], 1e-6);
    if (std::abs(found.values[a][0]) < 1.1 * std::abs(found.values[a][1])) continue;  // the direction is not unique
    EXPECT_NEAR(std::abs(dot(rotate(found.directions[a]), other.directions[b])), 1, 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(LocalFeatures, DoNotDependOnThreadsAndOtherFeatures) {
  const TiledCloud cloud(hills(50), {.tile_points = 700});
  const TiledGraph graph = cloud.graph();
  tiles::TiledLocalMapOptions one{.maps = {.radius = 3}, .features = {"curvature"}}, many = one;
  one.maps.heat.threads = 1, many.maps.heat.threads = 3;
  many.features = {"area", "curvature", "count"};
  write_local_maps(graph, 2, cloud.file("one"), one), write_local_maps(graph, 2, cloud.file("many"), many);
  const ArrayFile a = local_file(cloud.file("one"), 2), b = local_file(cloud.file("many"), 2);
  EXPECT_TRUE(same_bits(a.get<Vec2>("curvatures"), b.get<Vec2>("curvatures")));
  EXPECT_TRUE(same_bits(a.get<Vec3>("directions"), b.get<Vec3>("directions")));
}

TEST(LocalFeatures, AreWrittenAsRowsOfTheInput) {
  std::vector<Vec3> points = hills(40);
  points.push_back(points[77]);
  points.push_back({0, 0, 5000});  // has no vertex
  const TiledCloud cloud(points, {.tile_points = 500});
  const TiledGraph graph = cloud.graph();
  const auto folder = cloud.file("features"), csv = cloud.file("features.csv");
  std::vector<double> half(points.size(), 0.5);
  half[77] = half[1600] = NAN;
  write_column(cloud.file("half.npy"), half);
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 3;
  options.features = {"mean:" + cloud.file("half.npy").string(), "curvature", "area", "count"};
  for (std::size_t t = 0; t < graph.tiles(); ++t) write_local_maps(graph, t, folder, options);
  write_feature_rows(graph, folder, csv);
  std::map<int, std::string> rows =
      csv_rows(csv, "row,count,area,curvature_1,curvature_2,direction_x,direction_y,direction_z,mean_0");
  EXPECT_EQ(rows.size(), points.size());
  EXPECT_EQ(rows[1600], rows[77]);
  EXPECT_EQ(rows[1601], ",,,,,,,,");
  EXPECT_TRUE(rows[77].ends_with(",")) << rows[77];  // a neighbor without a value: no mean
  EXPECT_TRUE(rows[1500].ends_with(",0.5")) << rows[1500];
  const Index vertex = graph.vertex_of_row(Row(900)).value().index;
  const std::size_t tile = graph.tile_of(vertex), i = static_cast<std::size_t>(vertex - graph.first_vertex(tile));
  const ArrayFile file = local_file(folder, tile);
  EXPECT_EQ(numbers_of(rows[900])[0], file.get<Index>("count")[i]);
  EXPECT_EQ(numbers_of(rows[900])[1], file.get<double>("area")[i]);

  const auto tile_1 = Manifest::file(folder, "local", 1);
  const auto expect_refusal = [&](const std::string& message) {
    expect_error<IoError>([&] { write_feature_rows(graph, folder, csv); }, message);
  };
  std::filesystem::remove(tile_1);
  expect_refusal("000001.local");
  options.features = {"count"};
  write_local_maps(graph, 1, folder, options);
  expect_refusal("tile 1 has other features than tile 0");
  options.features = {};
  write_local_maps(graph, 1, cloud.file("maps"), options);
  copy_over(Manifest::file(cloud.file("maps"), "local", 1), tile_1);
  expect_refusal("whole maps");
  copy_over(Manifest::file(folder, "local", 0), tile_1);
  expect_refusal("other tiles");
}

TEST(LocalFeatures, RefuseUnknownNamesAndUnsuitableColumns) {
  const TiledCloud cloud(hills(30), {.tile_points = 2500});
  const TiledGraph graph = cloud.graph();
  const auto write = [&](const std::vector<std::string>& names) {
    write_local_maps(graph, 0, cloud.file("local"), {.maps = {.radius = 3}, .features = names});
  };
  const auto write_mean = [&](const char* name) { write({"mean:" + cloud.file(name).string()}); };
  expect_error<InvalidArgument>([&] { write({"cuont"}); }, "'cuont' is not one of count, area");
  expect_error<InvalidArgument>([&] { write({"area", "area"}); }, "'area' occurs twice");
  expect_error<IoError>([&] { write({"mean:"}); }, "''");
  expect_error<IoError>([&] { write_mean("missing.npy"); }, "missing.npy");
  for (const char* name : {"", "points.ply"}) expect_error<IoError>([&] { write_mean(name); }, "not a .npy file");
  write_column(cloud.file("short.npy"), std::vector<double>(899));
  expect_error<InvalidArgument>([&] { write_mean("short.npy"); }, "899 values; the input of the tiles has 900 rows");
  struct Column {
    const char *type, *shape;
    std::size_t values;
    const char* message;
  };
  for (const auto& [type, shape, values, message] :
       {Column{"<f8", "(900,)", 899, "truncated"}, Column{"<f4", "(900,)", 450, "float64"},
        Column{"<f8", "(450, 2)", 900, "one dimension"},
        Column{"<f8", "(99999999999999999999999,)", 0, "one dimension"}}) {
    write_npy(cloud.file("column.npy"), type, shape, bytes_of(std::vector<double>(values)));
    expect_error<IoError>([&] { write_mean("column.npy"); }, message);
  }
  EXPECT_FALSE(std::filesystem::exists(Manifest::file(cloud.file("local"), "local", 0)));
}

}  // namespace
}  // namespace ahm::test
