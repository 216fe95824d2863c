// Answers of a session are the results of the library. Unsuitable requests are errors.
#include <array>
#include <fstream>
#include <numbers>
#include <random>
#include <set>
#include <thread>

#include "ahm/applications/coverage.hpp"
#include "ahm/applications/stroke.hpp"
#include "ahm/io/image.hpp"
#include "ahm/maps/log_map_solver.hpp"
#include "ahm/pointcloud/point_cloud_surface.hpp"
#include "ahm/surface/exact/exact_geodesics.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/util/shell.hpp"
#include "sessions.hpp"

namespace ahm::viewer::test {
namespace {

Answer answer(const Session& session, const char* name, json request) {
  request["client"] = "test";
  return session.answer(name, request.dump());
}

json json_answer(const Session& session, const char* name, const json& request) {
  const Answer found = answer(session, name, request);
  EXPECT_EQ(found.status, 200) << found.body;
  return json::parse(found.body);
}

Bundle bundle_answer(const Session& session, const char* name, const json& request) {
  const Answer found = answer(session, name, request);
  EXPECT_EQ(found.status, 200) << found.body;
  return Bundle(found.body);
}

Bundle surface_of(const Session& session) { return Bundle(session.answer("surface", {}).body); }
double scale_of(const Session& session) { return surface_of(session).meta.at("scale").get<double>(); }

json at_row(int row) { return {{"row", row}}; }
json from_row(int row, const json& more = json::object()) {
  json request = more;
  request["source"] = at_row(row);
  return request;
}
json path_between(int from, int to) { return {{"from", at_row(from)}, {"to", at_row(to)}}; }
json stroke_between(int from, int to) { return {{"points", {at_row(from), at_row(to)}}}; }
json tool_path(double radius, double spacing, const char* pattern) {
  return {{"coverage_radius", radius}, {"spacing", spacing}, {"pattern", pattern}};
}

/// The same values in single precision.
void expect_same(const Bundle& bundle, const RowLogMap& rows, double scale) {
  const auto uv = bundle.array<float>("uv"), distance = bundle.array<float>("distance");
  const auto spread = bundle.array<float>("spread");
  const auto status = bundle.array<std::uint8_t>("status");
  const auto same = [&](float a, double b) {
    return a == static_cast<float>(b / scale) || (std::isnan(a) && std::isnan(b));
  };
  ASSERT_EQ(uv.size(), 2 * rows.u.size());
  for (std::size_t i = 0; i < rows.u.size(); ++i) {
    ASSERT_EQ(status[i], static_cast<std::uint8_t>(rows.status[i]));
    ASSERT_TRUE(same(uv[2 * i], rows.u[i]) && same(uv[2 * i + 1], rows.v[i])) << i;
    ASSERT_TRUE(same(distance[i], rows.distance[i]) && same(spread[i], rows.spread[i])) << i;
  }
}

class ViewerSession : public testing::Test {
 protected:
  const Sphere sphere;
  const trimesh::TriangleMeshSurface& surface = sphere.surface;
  const Session session{surface, sphere.geometry, sphere_options()};
};

TEST_F(ViewerSession, MapsHaveTheSettingsOfTheRequest) {
  const auto usual = LogMapSolver(surface.graph()).solve(surface.source(Row{7}).source);
  expect_same(bundle_answer(session, "map", from_row(7)), surface.to_rows(usual), scale_of(session));

  const LogMapSolver solver(surface.graph(), {.t_coef = 2});
  const auto localized =
      solver.solve(surface.source(Row{7}, Vec3{0, 0.3, 1}).source, {.variant = Variant::localized, .radius = 1});
  const json settings = {{"variant", "localized"}, {"t_coef", 2}, {"radius", 1}, {"u_axis", {0, 0.3, 1}}};
  const Bundle heat = bundle_answer(session, "map", from_row(7, settings));
  expect_same(heat, surface.to_rows(localized), scale_of(session));
  EXPECT_EQ(heat.meta.at("command"),
            "ahm logmap sphere.ply --source 7 -o map.csv --method heat --variant localized --t-coef 2 --radius 1 "
            "--u-axis=0,0.3,1");

  const FacePoint point{11, {0.2, 0.3, 0.5}};
  const auto exact = ExactGeodesics(surface).log_map(point, surface.source(point).frame->x, {.frames = true});
  const Bundle found =
      bundle_answer(session, "map", {{"source", {{"face", 11}, {"weights", {0.2, 0.3, 0.5}}}}, {"method", "exact"}});
  expect_same(found, surface.to_rows(exact), scale_of(session));
  EXPECT_EQ(found.meta.at("spec"), "face:11:0.2,0.3,0.5");
  EXPECT_EQ(found.meta.at("command"), "ahm logmap sphere.ply --source face:11:0.2,0.3,0.5 -o map.csv --method exact");
}

TEST_F(ViewerSession, ARadiusOfNullIsNoRadius) {
  SessionOptions options = sphere_options();
  options.settings.radius = 0.5;
  const Session near(surface, sphere.geometry, options);
  const auto count_ok = [&](const json& more) {
    const auto status = bundle_answer(near, "map", from_row(7, more)).array<std::uint8_t>("status");
    return std::ranges::count(status, static_cast<std::uint8_t>(Status::ok));
  };
  const auto all = static_cast<std::ptrdiff_t>(sphere.mesh.positions.size());
  EXPECT_LT(count_ok(json::object()), all);
  EXPECT_EQ(count_ok({{"radius", nullptr}}), all);
}

/// On large surfaces, maps, strokes and tool paths within a radius are marched; no factorization is needed.
TEST(LargeViewerSession, MarchesWithinARadius) {
  const Sphere sphere(142);
  const auto& surface = sphere.surface;
  ASSERT_GT(surface.graph().size(), 200'000);
  SessionOptions options = sphere_options();
  options.settings.radius = 0.05;
  const Session session(surface, sphere.geometry, options);
  const LogMapSolver march(surface.graph(), {.strategy = Strategy::march});
  const double scale = scale_of(session);
  const Source source = surface.source(Row{7}).source;
  expect_same(bundle_answer(session, "map", from_row(7)), surface.to_rows(march.solve(source, {.radius = 0.05})),
              scale);

  const std::vector<CurvePoint> ends{SurfacePoint(Row{7}), SurfacePoint(Row{9})};
  const SurfaceCurve curve = draw_curve(surface, ends);
  const double edge = surface.graph().mean_edge_length() * surface.graph().length_unit();
  const LogMap map = march.solve(curve.source, {.radius = 0.05 + 2 * edge});
  const Bundle stroke = bundle_answer(session, "stroke", stroke_between(7, 9));
  expect_same(stroke, rows_from_curve(surface, map, curve, 0.05), scale);
  EXPECT_EQ(stroke.meta.at("pattern"), "grid");
  EXPECT_GT(stroke.meta.at("curve").size(), 2U);
  EXPECT_EQ(stroke.meta.at("command"), "ahm stroke sphere.ply --curve '7 9' -o stroke.csv --radius 0.05");

  const CoveragePath expected = coverage_path(surface, inverse_map(surface, march.solve(source, {.frames = true})),
                                              {.radius = 0.1, .spacing = 0.02});
  const json path = json_answer(session, "coverage", from_row(7, tool_path(0.1, 0.02, "raster")));
  EXPECT_EQ(path.at("points").size(), expected.points.size());
  EXPECT_EQ(path.at("pieces").size(), static_cast<std::size_t>(expected.pieces));
  EXPECT_GT(path.at("covered").get<double>(), 0.9);
  EXPECT_EQ(path.at("command"),
            "ahm coverage sphere.ply --source 7 --radius 0.1 --spacing 0.02 --pattern raster -o path.csv");
}

TEST_F(ViewerSession, TrianglesHaveTheirFacesAndRows) {
  const Bundle bundle = surface_of(session);
  const auto triangles = bundle.array<std::uint32_t>("triangles");
  const auto points = bundle.array<std::int32_t>("points"), faces = bundle.array<std::int32_t>("faces");
  const auto positions = bundle.array<float>("positions");
  ASSERT_EQ(faces.size(), sphere.mesh.faces.size());
  ASSERT_EQ(triangles.size(), 3 * faces.size());
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(points[triangles[3 * t + k]], sphere.mesh.faces[static_cast<std::size_t>(faces[t])][k]);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(positions[3 * i + c] * scale_of(session) + bundle.meta.at("center")[c].get<double>(),
                  sphere.mesh.positions[static_cast<std::size_t>(points[i])][c], 1e-6);
}

TEST_F(ViewerSession, PathsAreShortest) {
  const json path = json_answer(session, "path", path_between(0, 30));
  const std::array<SurfacePoint, 2> ends{Row{0}, Row{30}};
  EXPECT_NEAR(path.at("length").get<double>() * scale_of(session), ExactGeodesics(surface).path(ends).length, 1e-12);
  EXPECT_EQ(path.at("command"), "ahm path sphere.ply --from 0 --to 30 -o path.obj");
}

TEST_F(ViewerSession, RefusesUnsuitableValues) {
  for (const json& source : {json(at_row(1000000)), json(at_row(-1)), json{{"row", 1.5}}, json("7"), json(),
                             json{{"face", 3}, {"weights", {1, 1, 1}}}, json{{"face", 3}, {"weights", {1}}}}) {
    const Answer found = answer(session, "map", {{"source", source}});
    EXPECT_EQ(found.status, 400) << source;
    EXPECT_FALSE(json::parse(found.body).at("error").get<std::string>().empty());
  }
  for (const json& more :
       {json{{"method", "magic"}}, json{{"t_coef", 0}}, json{{"radius", -1}}, json{{"u_axis", {0, 0, 0}}}})
    EXPECT_EQ(answer(session, "map", from_row(7, more)).status, 400) << more;
  EXPECT_EQ(answer(session, "map", json::object()).status, 400);
  EXPECT_EQ(answer(session, "passwd", json::object()).status, 404);
  EXPECT_EQ(answer(session, "map", from_row(7)).status, 200);
}

TEST_F(ViewerSession, RefusesBodiesThatNoPageSends) {
  std::vector<std::string> bodies{"",
                                  "{",
                                  "null",
                                  "[]",
                                  "3",
                                  "\"map\"",
                                  std::string(100'000, '['),
                                  std::string(1000, '\0'),
                                  "\xff\xfe{}",
                                  R"({"client": 3})",
                                  R"({"client": null})",
                                  R"({"client": "a", "source": {"row": 1e999}})",
                                  R"({"client": "a", "source": {"row": 18446744073709551615}})",
                                  R"({"client": "a", "source": {"face": 0, "weights": [1e308, -1e308, 1]}})",
                                  R"({"client": ")" + std::string(65, 'a') + R"(", "source": {"row": 0}})"};
  std::string deep = R"({"client": "a", "source": )";
  for (int k = 0; k < 50'000; ++k) deep += R"({"row":)";
  bodies.push_back(deep + "0" + std::string(50'000, '}') + "}");
  std::mt19937 random(1);
  for (int k = 0; k < 200; ++k) {
    std::string noise(random() % 200, ' ');
    for (char& c : noise) c = static_cast<char>(random());
    bodies.push_back(noise);
  }
  for (const char* name : {"map", "stroke", "path", "coverage", "export"})
    for (const std::string& body : bodies) {
      const Answer found = session.answer(name, body);
      EXPECT_EQ(found.status, 400) << name << ' ' << body.substr(0, 60);
      EXPECT_TRUE(json::parse(found.body).contains("error"));
    }
  EXPECT_EQ(answer(session, "map", from_row(0)).status, 200);
}

TEST_F(ViewerSession, AnswersTheNewestOfManyRequests) {
  for (const auto& [name, request] : {std::pair("map", from_row(3)),
                                      {"path", path_between(0, 30)},
                                      {"coverage", from_row(3, tool_path(0.5, 0.1, "raster"))}}) {
    std::vector<Answer> answers(24);
    {
      std::vector<std::jthread> threads;
      for (Answer& found : answers)
        threads.emplace_back([&, name = name, request = request] { found = answer(session, name, request); });
    }
    for (const Answer& found : answers) EXPECT_TRUE(found.status == 200 || found.status == 409) << found.body;
    EXPECT_EQ(answer(session, name, request).status, 200);
  }
}

/// Requests of each client are numbered. Strokes are of the same kind as maps.
TEST_F(ViewerSession, CancelsRequestsOlderThanTheNewest) {
  const auto status = [&](const char* name, json request, const json& number, const char* client = "a") {
    request["number"] = number, request["client"] = client;
    return session.answer(name, request.dump()).status;
  };
  EXPECT_EQ(status("map", from_row(3), 5), 200);
  EXPECT_EQ(status("map", from_row(3), 4), 409);
  EXPECT_EQ(status("map", from_row(3), 6), 200);
  EXPECT_EQ(status("map", from_row(3), 1, "b"), 200);
  EXPECT_EQ(status("map", from_row(3), -1), 400);
  EXPECT_EQ(status("map", from_row(3), "7"), 400);
  EXPECT_EQ(status("stroke", stroke_between(0, 30), 2), 409);
}

/// Rows that were left out or have no finite position are shown and chosen as the nearest remaining row.
TEST(ViewerSessionOfACloud, HasTheRowsOfAThinnedCloud) {
  io::Geometry geometry;
  std::vector<Row> kept;
  std::set<std::int32_t> expected;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) {
      const auto row = static_cast<Index>(geometry.points.size());
      if (x % 2 == 0 && y % 2 == 0) kept.emplace_back(row), expected.insert(row);
      geometry.points.push_back({0.1 * x, 0.1 * y + 0.03 * (x % 2), 0});
    }
  geometry.points.push_back({NAN, 0, 0});
  const auto cloud = pointcloud::PointCloudSurface::build(geometry.points, {}, {.rows = kept});
  const auto nearest = [&](std::size_t row) { return cloud.nearest_row(geometry.points[row]).index; };
  SessionOptions options = sphere_options();
  options.source = Row(41);
  const Session session(cloud, geometry, options);
  const auto points = surface_of(session).array<std::int32_t>("points");
  EXPECT_EQ(std::set(points.begin(), points.end()), expected);
  EXPECT_EQ(json::parse(session.answer("info", {}).body).at("source").at("row"), nearest(41));
  EXPECT_EQ(bundle_answer(session, "map", from_row(83)).meta.at("spec"), std::to_string(nearest(83)));
  EXPECT_EQ(answer(session, "stroke", stroke_between(1, 83)).status, 200);
  EXPECT_EQ(answer(session, "path", path_between(1, 83)).status, 200);
  for (const int row : {1600, 1601}) EXPECT_EQ(answer(session, "map", from_row(row)).status, 400);
}

TEST(ViewerSessionOfACloud, IsDrawnByItsTrianglesAndHasPaths) {
  io::Geometry geometry;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) geometry.points.push_back({0.1 * x, 0.1 * y, 0});
  const auto cloud = pointcloud::PointCloudSurface::build(geometry.points);
  const Session session(cloud, geometry, sphere_options());
  const Bundle surface = surface_of(session);
  EXPECT_TRUE(surface.meta.at("is_cloud"));
  EXPECT_EQ(surface.array<std::uint32_t>("triangles").size(), 3 * 2 * 19 * 19);
  const auto points = surface.array<std::int32_t>("points");
  EXPECT_EQ(std::set(points.begin(), points.end()).size(), geometry.points.size());
  const json path = json_answer(session, "path", path_between(0, 3));
  EXPECT_NEAR(path.at("length").get<double>() * scale_of(session), 0.3, 1e-9);
}

TEST_F(ViewerSession, CoversTheWholeSurface) {
  const Session on_sphere(surface, sphere.geometry, sphere_options());
  const double scale = scale_of(on_sphere);
  const json curve = {at_row(0), at_row(30)};
  for (const auto& [drawn, spiral] : {std::pair(false, false), {true, false}, {false, true}}) {
    json request{{"spacing", 0.25}};
    if (drawn) request["curve"] = curve;
    if (spiral) request["pattern"] = "spiral";
    ToolPathOptions options{.spacing = 0.25, .spiral = spiral};
    if (drawn) options.seed = CurveSeed{{surface.position(Row{0}), surface.position(Row{30})}};
    const ToolPath expected = ahm::tool_path(surface, options);
    const json path = json_answer(on_sphere, "whole", request);
    EXPECT_EQ(path.at("passes").at("pieces").size(), expected.passes.size());
    EXPECT_NEAR(path.at("length").get<double>() * scale, expected.pass_length, 1e-9);
    EXPECT_NEAR(path.at("link_length").get<double>() * scale, expected.link_length, 1e-9);
    EXPECT_NEAR(path.at("area").get<double>() * scale * scale, 4 * std::numbers::pi, 0.5);
    EXPECT_GT(path.at("covered").get<double>(), 0.99);
    EXPECT_FALSE(path.at("links").at("points").empty());
    EXPECT_EQ(path.at("command"), std::string("ahm coverage sphere.ply --whole --spacing 0.25 ") +
                                      (spiral ? "--pattern spiral " : "") + (drawn ? "--seed-curve '0 30' " : "") +
                                      "-o whole.csv");
  }
  EXPECT_EQ(answer(on_sphere, "whole", {{"spacing", 1e-6}}).status, 400);
  EXPECT_EQ(answer(on_sphere, "whole", {{"spacing", 1e3}}).status, 400);
  EXPECT_EQ(answer(on_sphere, "whole", {{"spacing", 0.25}, {"pattern", "zigzag"}}).status, 400);
}

TEST_F(ViewerSession, DrawsIsolinesOfColumns) {
  io::Geometry geometry = sphere.geometry;
  std::vector<double> heights;
  for (const Vec3& p : geometry.points) heights.push_back(100 * p[2]);
  geometry.properties = {{"height in cm", heights}, {"constant", std::vector<double>(heights.size(), 1)}};
  const Session session(surface, geometry, sphere_options());
  const json columns = json::parse(session.answer("info", "").body).at("columns");
  ASSERT_EQ(columns.size(), 4U);  // x, y, z, height in cm
  EXPECT_EQ(columns[3].at("name"), "height in cm");
  EXPECT_EQ(columns[3].at("low"), *std::ranges::min_element(heights));
  const json lines = json_answer(session, "isolines", {{"column", "height in cm"}, {"every", 30}});
  double length = 0;
  for (const Isoline& line : isolines(surface, heights, level_multiples(heights, 30))) length += line.length;
  EXPECT_NEAR(lines.at("length").get<double>() * scale_of(session), length, 1e-9);
  EXPECT_EQ(lines.at("lines"), 7);  // -90 ... 90
  EXPECT_EQ(lines.at("pieces").size(), 7U);
  const json &points = lines.at("points"), &pieces = lines.at("pieces");
  EXPECT_EQ(points[0], points[pieces[1].get<std::size_t>() - 1]);  // closed
  EXPECT_EQ(lines.at("command"), "ahm isolines sphere.ply --column 'height in cm' --every 30 -o isolines.obj");
  for (const json& bad : {json{{"column", "none"}, {"every", 1}},
                          {{"column", "z"}, {"every", 0}},
                          {{"column", "z"}, {"every", 1e-4}},
                          {{"column", "constant"}, {"every", 3}}})
    EXPECT_EQ(answer(session, "isolines", bad).status, 400) << bad;
}

TEST_F(ViewerSession, ExportsTheFilesOfItsWriters) {
  SessionOptions options = sphere_options();
  for (const char* what : {"map", "stroke", "path", "coverage", "whole", "isolines", "decal"})
    options.formats[what] = {"csv"};
  std::filesystem::path folder;
  std::vector<Vec3> path;
  CoveragePath covered;
  DecalOptions decal_options;
  using File = std::filesystem::path;
  options.write = [&](const File& file, const RowLogMap& rows, const std::vector<double>& quality) {
    folder = file.parent_path();
    std::ofstream(file) << rows.u.size() << ' ' << quality.size();
  };
  options.write_path = [&](const File& file, const std::vector<Vec3>& points) {
    std::ofstream(file) << (path = points).size();
  };
  options.write_coverage = [&](const File& file, const CoveragePath& points) {
    std::ofstream(file) << (covered = points).points.size();
  };
  options.write_whole = [&](const File& file, const ToolPath& points) { std::ofstream(file) << points.poses.size(); };
  options.write_isolines = [&](const File& file, const std::vector<Isoline>& lines) {
    std::ofstream(file) << lines.size();
  };
  options.write_decal = [&](const File& file, const InverseMap&, const DecalOptions& decal, const Image& image) {
    decal_options = decal;
    std::ofstream(file) << image.width << ' ' << image.height;
  };
  const Session exporting(surface, sphere.geometry, options);
  const auto exported = [&](const char* what, json request, const char* format = "csv") {
    request["what"] = what, request["format"] = format;
    return answer(exporting, "export", request);
  };
  const std::string n = std::to_string(sphere.mesh.positions.size());
  EXPECT_EQ(exported("map", from_row(0)).body, n + " " + n);
  EXPECT_EQ(exported("stroke", stroke_between(0, 30)).body, n + " " + n);
  EXPECT_FALSE(folder.empty());
  EXPECT_FALSE(std::filesystem::exists(folder));

  const ExactGeodesics geodesics(surface);
  const std::array ends{SurfacePoint(Row{0}), SurfacePoint(Row{30})};
  const auto direct = geodesics.paths(std::span(&ends, 1)).front();
  ASSERT_EQ(exported("path", path_between(0, 30)).body, std::to_string(direct.points.size()));
  for (std::size_t k = 0; k < path.size(); ++k) EXPECT_EQ(path[k], geodesics.position(direct.points[k]));

  ASSERT_EQ(exported("coverage", from_row(0, tool_path(0.5, 0.1, "spiral"))).status, 200);
  const LogMap map = LogMapSolver(surface.graph()).solve(surface.source(Row{0}).source, {.frames = true});
  const CoveragePath expected = coverage_path(surface, inverse_map(surface, map),
                                              {.radius = 0.5, .spacing = 0.1, .pattern = CoveragePattern::spiral});
  ASSERT_EQ(covered.points.size(), expected.points.size());
  for (std::size_t k = 0; k < expected.points.size(); ++k)
    EXPECT_EQ(covered.points[k].position, expected.points[k].position);

  EXPECT_EQ(exported("whole", {{"spacing", 0.3}}).body,
            std::to_string(ahm::tool_path(surface, {.spacing = 0.3}).poses.size()));

  EXPECT_EQ(exported("isolines", {{"column", "z"}, {"every", 0.3}}).body, "7");

  const auto decal = [&](const char* image) {
    return exported("decal", from_row(0, {{"size", 0.4}, {"angle", 90}, {"image", image}}));
  };
  if (io::has_images()) {  // a PNG of 2 x 1 pixels
    EXPECT_EQ(
        decal("iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg==").body,
        "2 1");
    EXPECT_EQ(decal_options.width, 0.4);
    EXPECT_EQ(decal_options.height, 0.2);
    EXPECT_EQ(decal_options.angle, std::numbers::pi / 2);
  }
  for (const char* image : {"", "?", "iVBORw0KGgo=", "../../etc/passwd"}) EXPECT_EQ(decal(image).status, 400) << image;
  EXPECT_EQ(exported("map", from_row(0), "../csv").status, 400);
  EXPECT_EQ(exported("surface", from_row(0)).status, 400);
}

TEST(ViewerCommand, NumbersFacesAsTheFileDoes) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Offset> begin{0, 3, 6, 9};
  const std::vector<Index> corners{0, 1, 1, 0, 1, 2, 0, 2, 3};
  const RepairedMesh mesh = repair_mesh(points, {begin, corners}, RepairOptions::all());
  const std::vector<Triangle> faces{{0, 1, 2}, {0, 2, 3}};
  const RepairedSurface surface(
      std::make_unique<trimesh::TriangleMeshSurface>(trimesh::TriangleMeshSurface::build(points, faces)), points, mesh);
  EXPECT_EQ(spec(surface, FacePoint{1, {0.25, 0.25, 0.5}}), "face:2:0.25,0.25,0.5");
}

TEST(ViewerCommand, QuotesSpecialCharacters) {
  EXPECT_EQ(detail::shell_word("scan.ply"), "scan.ply");
  EXPECT_EQ(detail::shell_word("my scan.ply"), "'my scan.ply'");
  EXPECT_EQ(detail::shell_word("it's; rm -rf $HOME"), "'it'\\''s; rm -rf $HOME'");
  EXPECT_EQ(detail::shell_word(""), "''");
}

}  // namespace
}  // namespace ahm::viewer::test
