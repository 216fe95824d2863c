// Of the map around each vertex only some numbers are kept: what they are, and that no driver changes them.
#include <gtest/gtest.h>

#include "ahm/error.hpp"
#include "ahm/tiles/tiled_local_maps.hpp"
#include "ahm/util/vec.hpp"
#include "csv_lines.hpp"
#include "npy_column.hpp"
#include "support/expect_error.hpp"
#include "tiled_clouds.hpp"

namespace ahm::test {
namespace {

using std::filesystem::path;
using tiles::ArrayFile;
using tiles::Manifest;
using tiles::TiledGraph;

/// A file as NumPy writes it.
TEST(LocalFeatures, CountTheVerticesOfMapsAndAddTheirMasses) {
  const TiledCloud cloud(hills(60), {.tile_points = 1000});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto folder = cloud.folder.directory() / "local", both = cloud.folder.directory() / "both";
  write_local_maps(graph, 1, folder, {.maps = {.radius = 3}});
  write_local_maps(graph, 1, both, {.maps = {.radius = 3}, .features = {"area", "count"}});
  const ArrayFile maps(Manifest::file(folder, "local", 1), "local"), reduced(Manifest::file(both, "local", 1), "local");
  const auto indptr = maps.get<Offset>("indptr");
  const auto weights = maps.get<double>("weights"), area = reduced.get<double>("area");
  const auto count = reduced.get<Index>("count");
  ASSERT_EQ(count.size() + 1, indptr.size());
  ASSERT_GT(count.size(), 500u);
  for (std::size_t s = 0; s < count.size(); ++s) {
    EXPECT_EQ(count[s], indptr[s + 1] - indptr[s]);
    double sum = 0;
    for (Offset e = indptr[s]; e < indptr[s + 1]; ++e) sum += weights[e];
    EXPECT_EQ(area[s], sum);
  }
}

/// That of a constant is the constant; two rows at one point count with their mean.
TEST(LocalFeatures, TakeMeansOfColumnsByMass) {
  std::vector<Vec3> points = hills(60);
  points.push_back(points[1830]);
  const TiledCloud cloud(points, {.tile_points = 1000});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory();
  std::vector<double> heights, constant(points.size(), 0.7);
  for (const Vec3& p : points) heights.push_back(p[2]);
  heights.back() = 100;
  write_column(directory / "height.npy", heights), write_column(directory / "constant.npy", constant);
  std::vector<double> of_vertex(static_cast<std::size_t>(graph.size()));
  for (std::size_t r = 0; r + 1 < points.size(); ++r)
    of_vertex[graph.vertex_of_row(Row(static_cast<Index>(r))).value().index] = heights[r];
  const Index twice = graph.vertex_of_row(Row(1830)).value().index;
  ASSERT_EQ(graph.vertex_of_row(Row(60 * 60)), Vertex(twice));
  of_vertex[twice] = (points[1830][2] + 100) / 2;
  const std::size_t tile = graph.tile_of(twice);
  const std::vector<std::string> names{"mean:" + (directory / "height.npy").string(),
                                       "mean:" + (directory / "constant.npy").string()};
  write_local_maps(graph, tile, directory / "maps", {.maps = {.radius = 3}});
  write_local_maps(graph, tile, directory / "means", {.maps = {.radius = 3}, .features = names});
  const ArrayFile maps(Manifest::file(directory / "maps", "local", tile), "local"),
      reduced(Manifest::file(directory / "means", "local", tile), "local");
  const auto indptr = maps.get<Offset>("indptr");
  const auto neighbors = maps.get<Index>("neighbors");
  const auto weights = maps.get<double>("weights"), mean = reduced.get<double>("mean");
  ASSERT_EQ(mean.size(), 2 * (indptr.size() - 1));
  for (std::size_t s = 0; s + 1 < indptr.size(); ++s) {
    double sum = 0, all = 0;
    for (Offset e = indptr[s]; e < indptr[s + 1]; ++e) sum += weights[e] * of_vertex[neighbors[e]], all += weights[e];
    EXPECT_NEAR(mean[2 * s], sum / all, 1e-13 * 100);
    EXPECT_NEAR(mean[2 * s + 1], 0.7, 1e-14);
  }
}

/// Curvatures of all vertices, tile after tile.
struct Curvatures {
  Curvatures(const TiledCloud& cloud, double radius) {
    const TiledGraph graph(cloud.tiles, 1 << 30);
    const auto folder = cloud.folder.directory() / "curvature";
    for (std::size_t t = 0; t < graph.tiles(); ++t) {
      EXPECT_TRUE(write_local_maps(graph, t, folder, {.maps = {.radius = radius}, .features = {"curvature"}}));
      const ArrayFile file(Manifest::file(folder, "local", t), "local");
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

/// Points of a sphere, evenly.
std::vector<Vec3> even_sphere(Index count, double radius) {
  std::vector<Vec3> points;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (Index i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), a = golden * i;
    points.push_back({radius * r * std::cos(a), radius * r * std::sin(a), radius * z});
  }
  return points;
}

/// A jittered grid rolled up, the axis along z, 1 apart.
std::vector<Vec3> cylinder(double radius) {
  std::vector<Vec3> points;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  const auto round = static_cast<Index>(2 * std::numbers::pi * radius);
  for (Index i = 0; i < round; ++i)
    for (Index j = 0; j < 30; ++j) {
      const double a = (i + shift(random)) * 2 * std::numbers::pi / round;
      points.push_back({radius * std::cos(a), radius * std::sin(a), j + shift(random)});
    }
  return points;
}

/// A circle's height over its length s is s^2 / 2r - s^4 / 24r^3: fitted within R this is less curved by at most R^2 / 16 r^2 on
/// spheres, R^2 / 12 r^2 on cylinders.
double by_fourth_order(double share) { return share * share / 12; }

TEST(LocalFeatures, CurvatureOfASphereIsThatOfItsRadius) {
  const double radius = 20, reach = 4;
  const TiledCloud cloud(even_sphere(3000, radius), {.tile_points = 1000});
  cloud.build();
  const std::vector<Vec2> curvatures = Curvatures(cloud, reach).values;
  const double outwards = curvatures[0][0] > 0 ? 1 : -1, tolerance = by_fourth_order(reach / radius);
  for (const Vec2& kappa : curvatures) {
    EXPECT_NEAR(outwards * kappa[0] * radius, 1, tolerance);
    EXPECT_NEAR(outwards * kappa[1] * radius, 1, tolerance);
    EXPECT_GE(std::abs(kappa[0]), std::abs(kappa[1]));
  }
}

TEST(LocalFeatures, CurvatureOfACylinderRunsRoundIt) {
  const double radius = 20, reach = 4;
  const TiledCloud cloud(cylinder(radius), {.tile_points = 1000});
  cloud.build();
  const Curvatures found(cloud, reach);
  const double tolerance = by_fourth_order(reach / radius);
  Index compared = 0;
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    const auto& [x, y, z] = found.positions[i];
    if (z < reach || z > 29 - reach) continue;  // a rim has neighbours on one side alone
    EXPECT_NEAR(std::abs(found.values[i][0]) * radius, 1, tolerance);
    EXPECT_NEAR(found.values[i][1] * radius, 0, tolerance);
    EXPECT_NEAR(std::abs(x * found.directions[i][1] - y * found.directions[i][0]) / radius, 1, tolerance);
    EXPECT_NEAR(norm(found.directions[i]), 1, 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 1500);
}

TEST(LocalFeatures, CurvatureOfAPlaneIsZero) {
  std::vector<Vec3> points = hills(40);
  for (Vec3& p : points) p[2] = 0.25 * p[0] - 0.5 * p[1] + 3;
  const TiledCloud cloud(points, {.tile_points = 500});
  cloud.build();
  for (const Vec2& kappa : Curvatures(cloud, 4).values) {
    EXPECT_NEAR(kappa[0], 0, 1e-9);
    EXPECT_NEAR(kappa[1], 0, 1e-9);
  }
}

/// Turned and twice as large: half as curved, along turned directions. Values by rows, since the curve of tiles does not turn.
TEST(LocalFeatures, CurvatureTurnsAndScalesWithTheCloud) {
  const std::vector<Vec3> points = hills(40);
  std::vector<Vec3> turned;
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turn = [&](const Vec3& p) { return Vec3{p[2], c * p[0] - s * p[1], s * p[0] + c * p[1]}; };
  for (const Vec3& p : points) turned.push_back(2.0 * turn(p));
  const TiledCloud cloud(points, {.tile_points = 700}), other(turned, {.tile_points = 700});
  cloud.build(), other.build();
  const TiledGraph graph(cloud.tiles, 1 << 30), other_graph(other.tiles, 1 << 30);
  const Curvatures found(cloud, 4), other_found(other, 8);
  Index compared = 0;
  for (Index row = 0; row < 1600; row += 3) {
    const Index a = graph.vertex_of_row(Row(row)).value().index, b = other_graph.vertex_of_row(Row(row)).value().index;
    const double side = dot(turn(graph.frame(a)->normal), other_graph.frame(b)->normal);
    ASSERT_NEAR(std::abs(side), 1, 1e-9);
    EXPECT_NEAR(2 * side * other_found.values[b][0], found.values[a][0], 1e-6);
    EXPECT_NEAR(2 * side * other_found.values[b][1], found.values[a][1], 1e-6);
    if (std::abs(found.values[a][0]) < 1.1 * std::abs(found.values[a][1])) continue;  // no direction is first
    EXPECT_NEAR(std::abs(dot(turn(found.directions[a]), other_found.directions[b])), 1, 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(LocalFeatures, CurvatureIsUnknownWithoutNeighbours) {
  const TiledCloud cloud(hills(20), {.tile_points = 2500});
  cloud.build();
  for (const Vec2& kappa : Curvatures(cloud, 0.1).values) EXPECT_TRUE(std::isnan(kappa[0]));
}

TEST(LocalFeatures, AreTheSameWhateverTheThreadsAndHowManyAreAskedFor) {
  const TiledCloud cloud(hills(50), {.tile_points = 700});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory();
  tiles::TiledLocalMapOptions one{.maps = {.radius = 3}, .features = {"curvature"}}, many = one;
  one.maps.heat.threads = 1, many.maps.heat.threads = 3;
  many.features = {"area", "curvature", "count"};
  write_local_maps(graph, 2, directory / "one", one), write_local_maps(graph, 2, directory / "many", many);
  const ArrayFile a(Manifest::file(directory / "one", "local", 2), "local"),
      b(Manifest::file(directory / "many", "local", 2), "local");
  EXPECT_TRUE(same_bits(a.get<Vec2>("curvatures"), b.get<Vec2>("curvatures")));
  EXPECT_TRUE(same_bits(a.get<Vec3>("directions"), b.get<Vec3>("directions")));
}

TEST(LocalFeatures, AreWrittenAsRowsOfTheInput) {
  std::vector<Vec3> points = hills(40);
  points.push_back(points[77]);
  points.push_back({0, 0, 5000});  // no vertex
  const TiledCloud cloud(points, {.tile_points = 500});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory(), folder = directory / "features", csv = directory / "features.csv";
  std::vector<double> half(points.size(), 0.5);
  half[77] = half[1600] = std::numeric_limits<double>::quiet_NaN();
  write_column(directory / "half.npy", half);
  tiles::TiledLocalMapOptions options;
  options.maps.radius = 3;
  options.features = {"mean:" + (directory / "half.npy").string(), "curvature", "area", "count"};
  for (std::size_t t = 0; t < graph.tiles(); ++t) write_local_maps(graph, t, folder, options);
  write_feature_rows(graph, folder, csv);
  std::map<int, std::string> rows =
      csv_lines(csv, "row,count,area,curvature_1,curvature_2,direction_x,direction_y,direction_z,mean_0");
  EXPECT_EQ(rows.size(), points.size());
  EXPECT_EQ(rows[1600], rows[77]);
  EXPECT_EQ(rows[1601], ",,,,,,,,");
  EXPECT_TRUE(rows[77].ends_with(",")) << rows[77];  // what is not a number among neighbours is none of the mean
  EXPECT_TRUE(rows[1500].ends_with(",0.5")) << rows[1500];
  const Vertex vertex = graph.vertex_of_row(Row(900)).value();
  const std::size_t tile = graph.tile_of(vertex.index);
  const ArrayFile kept(Manifest::file(folder, "local", tile), "local");
  const auto i = static_cast<std::size_t>(vertex.index - graph.first_vertex(tile));
  EXPECT_TRUE(rows[900].starts_with("," + std::to_string(kept.get<Index>("count")[i]) + ",")) << rows[900];
  const auto comma = rows[900].find(',', 1);
  EXPECT_EQ(std::stod(rows[900].substr(comma + 1)), kept.get<double>("area")[i]);

  std::filesystem::remove(Manifest::file(folder, "local", 1));
  expect_error<IoError>([&] { write_feature_rows(graph, folder, csv); }, "000001.local");
  options.features = {"count"};
  write_local_maps(graph, 1, folder, options);
  expect_error<IoError>([&] { write_feature_rows(graph, folder, csv); }, "tile 1 has other features than tile 0");
  options.features = {};
  write_local_maps(graph, 1, directory / "maps", options);
  std::filesystem::copy(Manifest::file(directory / "maps", "local", 1), Manifest::file(folder, "local", 1),
                        std::filesystem::copy_options::overwrite_existing);
  expect_error<IoError>([&] { write_feature_rows(graph, folder, csv); }, "whole maps");
  std::filesystem::copy(Manifest::file(folder, "local", 0), Manifest::file(folder, "local", 1),
                        std::filesystem::copy_options::overwrite_existing);
  expect_error<IoError>([&] { write_feature_rows(graph, folder, csv); }, "belongs to other tiles");
}

TEST(LocalFeatures, OfAnotherColumnAreNotTakenForThese) {
  const TiledCloud cloud(hills(30), {.tile_points = 2500});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory();
  const auto make = [&](const std::string& column) {
    return write_local_maps(graph, 0, directory / "local",
                            {.maps = {.radius = 3}, .features = {"mean:" + (directory / column).string()}});
  };
  std::vector<double> values(900, 1.0);
  write_column(directory / "a.npy", values), write_column(directory / "same.npy", values);
  values[450] = 2;
  write_column(directory / "b.npy", values);
  EXPECT_TRUE(make("a.npy"));
  EXPECT_FALSE(make("a.npy"));
  EXPECT_FALSE(make("same.npy"));
  expect_error<InvalidArgument>([&] { make("b.npy"); }, "other options");
}

TEST(LocalFeatures, ThatAreNoneAreRefused) {
  const TiledCloud cloud(hills(30), {.tile_points = 2500});
  cloud.build();
  const TiledGraph graph(cloud.tiles, 1 << 30);
  const auto directory = cloud.folder.directory();
  const auto make = [&](const std::vector<std::string>& names) {
    write_local_maps(graph, 0, directory / "local", {.maps = {.radius = 3}, .features = names});
  };
  const auto mean = [&](const char* name) { make({"mean:" + (directory / name).string()}); };
  expect_error<InvalidArgument>([&] { make({"cuont"}); }, "'cuont' is not one of count, area");
  expect_error<InvalidArgument>([&] { make({"area", "area"}); }, "'area' occurs twice");
  expect_error<IoError>([&] { make({"mean:"}); }, "cannot read ''");
  expect_error<IoError>([&] { mean("missing.npy"); }, "missing.npy");
  expect_error<IoError>([&] { make({"mean:" + directory.string()}); }, "not a .npy file");
  expect_error<IoError>([&] { make({"mean:" + cloud.input.string()}); }, "not a .npy file");
  write_column(directory / "short.npy", std::vector<double>(899));
  expect_error<InvalidArgument>([&] { mean("short.npy"); }, "899 value(s); the input of the tiles has 900 rows");
  write_npy(directory / "cut.npy", "<f8", "(900,)", bytes_of(std::vector<double>(899)));
  expect_error<IoError>([&] { mean("cut.npy"); }, "truncated");
  write_npy(directory / "single.npy", "<f4", "(900,)", bytes_of(std::vector<double>(450)));
  expect_error<IoError>([&] { mean("single.npy"); }, "not float64");
  write_npy(directory / "table.npy", "<f8", "(450, 2)", bytes_of(std::vector<double>(900)));
  expect_error<IoError>([&] { mean("table.npy"); }, "exactly one dimension");
  write_npy(directory / "huge.npy", "<f8", "(99999999999999999999999,)", {});
  expect_error<IoError>([&] { mean("huge.npy"); }, "exactly one dimension");
  EXPECT_FALSE(std::filesystem::exists(directory / "local" / "0.local"));
}

}  // namespace
}  // namespace ahm::test
