// What a page is told is what the library finds.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <numbers>
#include <set>
#include <thread>

#include "ahm/applications/coverage.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/io/image.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/trimesh/triangle_mesh_surface.hpp"
#include "ahm/util/shell.hpp"
#include "sphere.hpp"

namespace ahm::viewer::test {
namespace {

std::string request(json more) {
  more["client"] = "test";
  return more.dump();
}

std::string error_of(const Answer& answer) { return json::parse(answer.body).at("error"); }

class ViewerSession : public testing::Test {
 protected:
  Sphere sphere;
  Session session{sphere.surface, sphere.geometry, sphere_options()};
};

/// Or both NaN.
bool same(float a, double b) { return a == static_cast<float>(b) || (std::isnan(a) && std::isnan(b)); }

void expect_same(const RowLogMap& rows, const Unpacked& bundle, double scale) {
  const auto uv = bundle.array<float>("uv"), distance = bundle.array<float>("distance");
  const auto spread = bundle.array<float>("spread");
  const auto status = bundle.array<std::uint8_t>("status");
  ASSERT_EQ(uv.size(), 2 * rows.u.size());
  for (std::size_t i = 0; i < rows.u.size(); ++i) {
    ASSERT_EQ(status[i], static_cast<std::uint8_t>(rows.status[i]));
    ASSERT_TRUE(same(uv[2 * i], rows.u[i] / scale)) << i;
    ASSERT_TRUE(same(uv[2 * i + 1], rows.v[i] / scale)) << i;
    ASSERT_TRUE(same(distance[i], rows.distance[i] / scale)) << i;
    ASSERT_TRUE(same(spread[i], rows.spread[i] / scale)) << i;
  }
}

double scale_of(const Session& session) {
  return Unpacked(session.answer("surface", {}).body).meta.at("scale").get<double>();
}

TEST_F(ViewerSession, GivesTheMapTheLibraryGives) {
  const LogMapSolver solver(sphere.surface.graph());
  const auto expected = sphere.surface.to_rows(solver.solve(sphere.surface.source(Row{7}).source));
  const Answer answer = session.answer("map", request({{"source", {{"row", 7}}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  expect_same(expected, Unpacked(answer.body), scale_of(session));
}

TEST_F(ViewerSession, GivesExactSourcesInFaces) {
  const FacePoint point{11, {0.2, 0.3, 0.5}};
  const ExactGeodesics geodesics(sphere.surface);
  const auto u = sphere.surface.source(point).frame->x;
  const auto expected = sphere.surface.to_rows(geodesics.log_map(point, u, {.frames = true}));
  const Answer answer =
      session.answer("map", request({{"source", {{"face", 11}, {"weights", {0.2, 0.3, 0.5}}}}, {"method", "exact"}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Unpacked bundle(answer.body);
  expect_same(expected, bundle, scale_of(session));
  EXPECT_EQ(bundle.meta.at("spec"), "face:11:0.2,0.3,0.5");
  EXPECT_EQ(bundle.meta.at("command"), "ahm logmap sphere.ply --source face:11:0.2,0.3,0.5 -o map.csv --method exact");
}

TEST_F(ViewerSession, HonoursEverySetting) {
  HeatOptions heat;
  heat.t_coef = 2;
  const LogMapSolver solver(sphere.surface.graph(), heat);
  MapOptions options;
  options.variant = Variant::localized;
  options.radius = 1;
  const Vec3 axis{0, 0.3, 1};
  const auto expected = sphere.surface.to_rows(solver.solve(sphere.surface.source(Row{7}, axis).source, options));
  const Answer answer = session.answer(
      "map",
      request(
          {{"source", {{"row", 7}}}, {"variant", "localized"}, {"t_coef", 2}, {"radius", 1}, {"u_axis", {0, 0.3, 1}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  expect_same(expected, Unpacked(answer.body), scale_of(session));
  EXPECT_EQ(Unpacked(answer.body).meta.at("command"),
            "ahm logmap sphere.ply --source 7 -o map.csv --method heat --variant localized --t-coef 2 --radius 1 "
            "--u-axis=0,0.3,1");
}

TEST_F(ViewerSession, NullIsNoRadiusWhateverTheUsualOne) {
  SessionOptions near = sphere_options();
  near.settings.radius = 0.5;
  const Session other(sphere.surface, sphere.geometry, near);
  const auto reached = [&](const json& more) {
    json wanted = {{"source", {{"row", 7}}}};
    wanted.update(more);
    const auto status = Unpacked(other.answer("map", request(wanted)).body).array<std::uint8_t>("status");
    return std::ranges::count(status, static_cast<std::uint8_t>(Status::ok));
  };
  const auto all = static_cast<std::ptrdiff_t>(sphere.geometry.points.size());
  EXPECT_LT(reached(json::object()), all);
  EXPECT_EQ(reached({{"radius", nullptr}}), all);
}

/// What ends at a radius needs no factors of the whole: it is the march's, bit for bit.
class LargeViewerSession : public testing::Test {
 protected:
  LargeViewerSession() {
    near.settings.radius = 0.05;
    session.emplace(large.surface, large.geometry, near);
    HeatOptions heat;
    heat.strategy = Strategy::march;
    march.emplace(large.surface.graph(), heat);
  }

  Sphere large{142};
  SessionOptions near = sphere_options();
  std::optional<Session> session;
  std::optional<LogMapSolver> march;
};

TEST_F(LargeViewerSession, MarchesMaps) {
  ASSERT_GT(large.surface.graph().size(), 200'000);
  const auto expected = large.surface.to_rows(march->solve(large.surface.source(Row{7}).source, {.radius = 0.05}));
  const Answer answer = session->answer("map", request({{"source", {{"row", 7}}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  expect_same(expected, Unpacked(answer.body), scale_of(*session));
}

TEST_F(LargeViewerSession, MarchesStrokes) {
  const std::vector<CurvePoint> ends{SurfacePoint(Row{7}), SurfacePoint(Row{9})};
  const SurfaceCurve curve = draw_curve(large.surface, ends);
  const double edge = large.surface.graph().mean_edge_length() * large.surface.graph().length_unit();
  const LogMap map = march->solve(curve.source, {.radius = 0.05 + 2 * edge});
  const auto expected = rows_from_curve(large.surface, map, curve, 0.05);
  const Answer answer = session->answer("stroke", request({{"points", {{{"row", 7}}, {{"row", 9}}}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Unpacked bundle(answer.body);
  expect_same(expected, bundle, scale_of(*session));
  EXPECT_EQ(bundle.meta.at("command"), "ahm stroke sphere.ply --curve '7 9' -o stroke.csv --radius 0.05");
}

TEST_F(LargeViewerSession, MarchesToolPathsToTheirOwnRadius) {
  const SurfaceSource source = large.surface.source(Row{7});
  const LogMap map = march->solve(source.source, {.frames = true});
  const CoveragePath expected =
      coverage_path(large.surface, inverse_map(large.surface, map), {.radius = 0.1, .spacing = 0.02});
  const Answer answer = session->answer(
      "coverage", request({{"source", {{"row", 7}}}, {"cover", 0.1}, {"spacing", 0.02}, {"pattern", "raster"}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json path = json::parse(answer.body);
  EXPECT_EQ(path.at("points").size(), expected.points.size());
  EXPECT_EQ(path.at("pieces").size(), static_cast<std::size_t>(expected.pieces));
  EXPECT_EQ(path.at("command"),
            "ahm coverage sphere.ply --source 7 --radius 0.1 --spacing 0.02 --pattern raster -o path.csv");
}

TEST_F(ViewerSession, KnowsTheFaceAndTheRowsOfEveryTriangle) {
  const Unpacked bundle(session.answer("surface", {}).body);
  const auto triangles = bundle.array<std::uint32_t>("triangles");
  const auto points = bundle.array<std::int32_t>("points"), faces = bundle.array<std::int32_t>("faces");
  const auto positions = bundle.array<float>("positions");
  const double scale = bundle.meta.at("scale");
  ASSERT_EQ(faces.size(), sphere.geometry.face_count());
  ASSERT_EQ(triangles.size(), 3 * faces.size());
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(points[triangles[3 * t + k]], sphere.geometry.face(static_cast<std::size_t>(faces[t]))[k]);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(positions[3 * i + c] * scale + bundle.meta.at("center")[c].get<double>(),
                  sphere.geometry.points[static_cast<std::size_t>(points[i])][c], 1e-6);
}

TEST_F(ViewerSession, FindsPathsStrokesAndCoverage) {
  const json path = json::parse(session.answer("path", request({{"from", {{"row", 0}}}, {"to", {{"row", 30}}}})).body);
  const ExactGeodesics geodesics(sphere.surface);
  const std::array<SurfacePoint, 2> ends{Row{0}, Row{30}};
  EXPECT_NEAR(path.at("length").get<double>() * scale_of(session), geodesics.path(ends).length, 1e-12);
  EXPECT_EQ(path.at("command"), "ahm path sphere.ply --from 0 --to 30 -o path.obj");

  const Answer stroke = session.answer("stroke", request({{"points", {{{"row", 0}}, {{"row", 30}}}}}));
  ASSERT_EQ(stroke.status, 200) << stroke.body;
  EXPECT_EQ(Unpacked(stroke.body).meta.at("pattern"), "grid");
  EXPECT_GT(Unpacked(stroke.body).meta.at("curve").size(), 2U);

  const Answer covered = session.answer(
      "coverage", request({{"source", {{"row", 0}}}, {"cover", 0.5}, {"spacing", 0.1}, {"pattern", "spiral"}}));
  ASSERT_EQ(covered.status, 200) << covered.body;
  EXPECT_GT(json::parse(covered.body).at("points").size(), 20U);
  EXPECT_GT(json::parse(covered.body).at("covered").get<double>(), 0.9);
}

TEST_F(ViewerSession, RefusesWhatItCannotAnswer) {
  for (const json& bad :
       {json{{"source", {{"row", 1000000}}}}, json{{"source", {{"row", -1}}}}, json{{"source", {{"row", 1.5}}}},
        json{{"source", "7"}}, json::object(), json{{"source", {{"face", 3}, {"weights", {1, 1, 1}}}}},
        json{{"source", {{"face", 3}, {"weights", {1}}}}}, json{{"source", {{"row", 7}}}, {"method", "magic"}},
        json{{"source", {{"row", 7}}}, {"t_coef", 0}}, json{{"source", {{"row", 7}}}, {"radius", -1}},
        json{{"source", {{"row", 7}}}, {"u_axis", {0, 0, 0}}}}) {
    const Answer answer = session.answer("map", request(bad));
    EXPECT_EQ(answer.status, 400) << bad;
    EXPECT_FALSE(error_of(answer).empty());
  }
  EXPECT_EQ(session.answer("passwd", request({})).status, 404);
  EXPECT_EQ(session.answer("map", request({{"source", {{"row", 7}}}})).status, 200);
}

TEST_F(ViewerSession, OfManyRequestsOfAClientTheNewestIsAnswered) {
  const json source = {{"source", {{"row", 3}}}}, cover = {{"cover", 0.5}, {"spacing", 0.1}, {"pattern", "raster"}};
  json tool_path = source;
  tool_path.update(cover);
  for (const auto& [name, body] : {std::pair("map", request(source)), std::pair("coverage", request(tool_path)),
                                   std::pair("path", request({{"from", {{"row", 0}}}, {"to", {{"row", 30}}}}))}) {
    std::vector<Answer> answers(24);
    {
      std::vector<std::jthread> threads;
      for (Answer& answer : answers)
        threads.emplace_back([&, name = name, body = body] { answer = session.answer(name, body); });
    }
    for (const Answer& answer : answers) EXPECT_TRUE(answer.status == 200 || answer.status == 409) << answer.body;
    EXPECT_EQ(session.answer(name, body).status, 200);
  }
}

TEST_F(ViewerSession, ARequestThatIsOvertakenByANewerOneIsTheOneCancelled) {
  const auto numbered = [&](const json& number, const char* client = "a") {
    return session.answer("map", json{{"source", {{"row", 3}}}, {"number", number}, {"client", client}}.dump()).status;
  };
  EXPECT_EQ(numbered(5), 200);
  EXPECT_EQ(numbered(4), 409);
  EXPECT_EQ(numbered(6), 200);
  EXPECT_EQ(numbered(1, "b"), 200);  // another client counts for itself
  EXPECT_EQ(numbered(-1), 400);
  EXPECT_EQ(numbered("7"), 400);
  const json stroke = {{"points", {{{"row", 0}}, {{"row", 30}}}}, {"number", 2}, {"client", "a"}};
  EXPECT_EQ(session.answer("stroke", stroke.dump()).status, 409);  // of the same kind as a map
}

TEST(ViewerSessionOfACloud, ShowsAndTakesWhatIsLeftOfAThinnedOne) {
  io::Geometry geometry;
  std::vector<Row> kept;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) {
      if (x % 2 == 0 && y % 2 == 0) kept.emplace_back(static_cast<Index>(geometry.points.size()));
      geometry.points.push_back({0.1 * x, 0.1 * y + 0.03 * (x % 2), 0});
    }
  geometry.points.push_back({NAN, 0, 0});
  const auto cloud = pointcloud::PointCloudSurface::build(geometry.points, {}, {.rows = kept});
  SessionOptions options = sphere_options();
  options.source = Row(41);  // beside row 0
  const Session session(cloud, geometry, options);
  const auto points = Unpacked(session.answer("surface", {}).body).array<std::int32_t>("points");
  std::set<std::int32_t> drawn(points.begin(), points.end()), expected;
  for (const Row row : kept) expected.insert(row.index);
  EXPECT_EQ(drawn, expected);
  EXPECT_EQ(json::parse(session.answer("info", {}).body).at("source").at("row"),
            cloud.nearest_row(geometry.points[41]).index);

  const Answer answer = session.answer("map", request({{"source", {{"row", 83}}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(Unpacked(answer.body).meta.at("spec"), std::to_string(cloud.nearest_row(geometry.points[83]).index));
  EXPECT_EQ(session.answer("stroke", request({{"points", {{{"row", 1}}, {{"row", 83}}}}})).status, 200);
  EXPECT_EQ(session.answer("path", request({{"from", {{"row", 1}}}, {"to", {{"row", 83}}}})).status, 200);
  EXPECT_EQ(session.answer("map", request({{"source", {{"row", 1600}}}})).status, 400);  // it is nowhere
  EXPECT_EQ(session.answer("map", request({{"source", {{"row", 1601}}}})).status, 400);
}

TEST(ViewerSessionOfACloud, TellsGradientsOfEveryDiscAndHasNoPaths) {
  io::Geometry geometry;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) geometry.points.push_back({0.1 * x, 0.1 * y, 0});
  const auto cloud = pointcloud::PointCloudSurface::build(geometry.points);
  const Session session(cloud, geometry, sphere_options());
  const Answer answer = session.answer("map", request({{"source", {{"row", 0}}}, {"u_axis", {1, 0, 0}}}));
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Unpacked map(answer.body);
  const auto slopes = map.array<std::uint8_t>("slopes");
  ASSERT_EQ(slopes.size(), 6 * geometry.points.size());
  const double steepest = map.meta.at("steepest");
  const auto points = Unpacked(session.answer("surface", {}).body).array<std::int32_t>("points");
  const std::set<std::int32_t> rows(points.begin(), points.end());
  EXPECT_EQ(rows.size(), geometry.points.size());    // each once, however they are scattered
  for (std::size_t k = 0; k < points.size(); ++k) {  // in the plane the map is the identity
    const double du = steepest * (2.0 * slopes[6 * k] - 254) / 255,
                 dv = steepest * (2.0 * slopes[6 * k + 4] - 254) / 255;
    EXPECT_NEAR(du, 1, steepest * 2 / 255) << points[k];
    EXPECT_NEAR(std::abs(dv), 1, steepest * 2 / 255) << points[k];
  }
  const json path = json::parse(session.answer("path", request({{"from", {{"row", 0}}}, {"to", {{"row", 3}}}})).body);
  const Vec3 &a = geometry.points[0], &b = geometry.points[3];
  EXPECT_NEAR(path.at("length").get<double>() * scale_of(session), std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]),
              1e-9);
}

TEST(ViewerSessionExport, SendsWhatItsWriterWrites) {
  const Sphere sphere;
  SessionOptions options = sphere_options();
  for (const char* what : {"map", "stroke", "path", "coverage", "decal"}) options.formats[what] = {"csv"};
  std::filesystem::path folder;
  options.write = [&](const std::filesystem::path& file, const RowLogMap& rows, const std::vector<double>& quality) {
    folder = file.parent_path();
    std::ofstream(file) << rows.u.size() << ' ' << quality.size();
  };
  std::vector<Vec3> path;
  CoveragePath covered;
  DecalOptions laid;
  options.write_path = [&](const std::filesystem::path& file, const std::vector<Vec3>& points) {
    std::ofstream(file) << (path = points).size();
  };
  options.write_coverage = [&](const std::filesystem::path& file, const CoveragePath& points) {
    std::ofstream(file) << (covered = points).points.size();
  };
  options.write_decal = [&](const std::filesystem::path& file, const InverseMap&, const DecalOptions& decal,
                            const Image& image) {
    laid = decal;
    std::ofstream(file) << image.width << ' ' << image.height;
  };
  const Session session(sphere.surface, sphere.geometry, options);
  const auto sent = [&](json wanted) {
    wanted["format"] = "csv";
    return session.answer("export", request(wanted));
  };
  const std::string n = std::to_string(sphere.geometry.points.size());
  const json at = {{"row", 0}};
  EXPECT_EQ(sent({{"what", "map"}, {"source", at}}).body, n + " " + n);
  EXPECT_EQ(sent({{"what", "stroke"}, {"points", {at, {{"row", 30}}}}}).body, n + " " + n);
  EXPECT_FALSE(folder.empty());
  EXPECT_FALSE(std::filesystem::exists(folder));

  const std::string path_points = sent({{"what", "path"}, {"from", at}, {"to", {{"row", 30}}}}).body;
  const ExactGeodesics geodesics(sphere.surface);
  const std::array ends{SurfacePoint(Row{0}), SurfacePoint(Row{30})};
  const auto direct = geodesics.paths(std::span(&ends, 1)).front();
  ASSERT_EQ(path_points, std::to_string(direct.points.size()));
  for (std::size_t k = 0; k < path.size(); ++k) EXPECT_EQ(path[k], geodesics.position(direct.points[k]));

  const json cover = {{"what", "coverage"}, {"source", at}, {"cover", 0.5}, {"spacing", 0.1}, {"pattern", "spiral"}};
  ASSERT_EQ(sent(cover).status, 200);
  const LogMap map = LogMapSolver(sphere.surface.graph()).solve(sphere.surface.source(Row{0}).source, {.frames = true});
  const CoveragePath wanted = coverage_path(sphere.surface, inverse_map(sphere.surface, map),
                                            {.radius = 0.5, .spacing = 0.1, .pattern = CoveragePattern::spiral});
  ASSERT_EQ(covered.points.size(), wanted.points.size());
  for (std::size_t k = 0; k < wanted.points.size(); ++k)
    EXPECT_EQ(covered.points[k].position, wanted.points[k].position);

  // A PNG of 2 x 1 pixels.
  json decal = {
      {"what", "decal"},
      {"source", at},
      {"size", 0.4},
      {"angle", 90},
      {"image", "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg=="}};
  if (io::has_images()) {
    EXPECT_EQ(sent(decal).body, "2 1");
    EXPECT_EQ(laid.width, 0.4);
    EXPECT_EQ(laid.height, 0.2);
    EXPECT_EQ(laid.angle, std::numbers::pi / 2);
  }
  for (const char* image : {"", "?", "iVBORw0KGgo=", "../../etc/passwd"}) {
    decal["image"] = image;
    EXPECT_EQ(sent(decal).status, 400) << image;
  }
  EXPECT_EQ(session.answer("export", request({{"what", "map"}, {"source", at}, {"format", "../csv"}})).status, 400);
  EXPECT_EQ(sent({{"what", "surface"}, {"source", at}}).status, 400);
}

TEST(ViewerCommand, CountsTheFacesOfTheFileAfterARepair) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Offset> begin{0, 3, 6, 9};
  const std::vector<Index> corners{0, 1, 1, 0, 1, 2, 0, 2, 3};
  const RepairedMesh mesh = repair_mesh(points, {begin, corners}, RepairOptions::all());
  const std::vector<Triangle> faces{{0, 1, 2}, {0, 2, 3}};
  const RepairedSurface surface(
      std::make_unique<trimesh::TriangleMeshSurface>(trimesh::TriangleMeshSurface::build(points, faces)), points, mesh);
  EXPECT_EQ(spec(surface, FacePoint{1, {0.25, 0.25, 0.5}}), "face:2:0.25,0.25,0.5");
}

TEST(ViewerCommand, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(detail::shell_word("scan.ply"), "scan.ply");
  EXPECT_EQ(detail::shell_word("my scan.ply"), "'my scan.ply'");
  EXPECT_EQ(detail::shell_word("it's; rm -rf $HOME"), "'it'\\''s; rm -rf $HOME'");
  EXPECT_EQ(detail::shell_word(""), "''");
}

}  // namespace
}  // namespace ahm::viewer::test
