#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "ahm/error.hpp"
#include "ahm/io/temporary_folder.hpp"
#include "experiments/comparison.hpp"
#include "experiments/report.hpp"
#include "experiments/run_record.hpp"
#include "experiments/surfaces.hpp"

namespace ahm::bench {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Table, ComesBackFromItsFile) {
  Table table({"name", "with, comma", "number"});
  table.add({"a \"quoted\" word", "x,y", 0.1});
  table.add({"", {}, -3});
  const io::TemporaryFolder temporary("ahm_test_");
  const auto& folder = temporary.directory();
  table.write(folder / "table.csv");
  const Table back = Table::read(folder / "table.csv");
  EXPECT_EQ(back.columns(), table.columns());
  ASSERT_EQ(back.rows().size(), table.rows().size());
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(back.rows()[r][c].text(), table.rows()[r][c].text());
}

TEST(Table, SelectsRowsAndLeavesEmptyCellsOut) {
  Table table({"method", "error"});
  table.add({"a", 1.0});
  table.add({"b", 5.0});
  table.add({"a", {}});
  table.add({"a", 3.0});
  EXPECT_EQ(table.where("method", "a").numbers("error"), (std::vector{1.0, 3.0}));
  EXPECT_EQ(table.where("method", "a").mean("error"), 2);
  EXPECT_EQ(table.largest("error"), 5);
  EXPECT_EQ(table.smallest("error"), 1);
}

TEST(Table, RefusesWhatIsNoNumberAndWhatIsNotThere) {
  EXPECT_THROW(Cell(std::numeric_limits<double>::quiet_NaN()), InvalidArgument);
  EXPECT_THROW(Cell(std::numeric_limits<double>::infinity()), InvalidArgument);
  Table table({"method", "error"});
  EXPECT_THROW(table.add({"a"}), InvalidArgument);
  EXPECT_THROW(table.largest("error"), InvalidArgument);
  table.add({"a", 1});
  EXPECT_THROW(table.numbers("method"), InvalidArgument);
  EXPECT_THROW(table.numbers("nothing"), InvalidArgument);
  EXPECT_THROW(Table::read("/nowhere/table.csv"), IoError);
}

TEST(FittedOrder, IsTheExponentOfAPower) {
  const std::vector<double> h{0.5, 0.2, 0.05};
  std::vector<double> error;
  for (double x : h) error.push_back(7 * std::pow(x, 1.5));
  EXPECT_NEAR(fitted_order(h, error), 1.5, 1e-12);
}

TEST(Rings, CutTheLongestLengthIntoEqualParts) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rings(std::vector{0.0, 0.9, 1.1, 4.0, infinity}, 4), (std::vector{0, 0, 1, 3, -1}));
}

TEST(Surface, KnowsExactMapsAndPathsOfEdges) {
  const Surface square("square", {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  EXPECT_EQ(square.nearest({0.9, 0.8, 0}), 2);
  const std::vector<double> plane = lengths(square.plane_log(1)), paths = square.path_lengths(1);
  EXPECT_NEAR(plane[3], std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(paths[3], 2, 1e-15);  // around the corner: the diagonal joins the other two vertices
  const Surface sphere("sphere", split_icosphere(12));
  const std::vector<double> angles = lengths(sphere.sphere_log(0));
  EXPECT_NEAR(*std::ranges::max_element(angles), std::numbers::pi, 1e-12);
}

TEST(UserMeshes, AreRunAsWellAndBrokenFilesLeftOut) {
  const io::TemporaryFolder temporary("ahm_test_");
  const auto& folder = temporary.directory();
  std::ofstream(folder / "octahedron.off") << "OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
                                              "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n"
                                              "3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";
  std::ofstream(folder / "broken.off") << "OFF\n3 1 0\n0 0 0\n";
  std::ofstream(folder / "square.off") << "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  const Settings settings{.toy = true, .meshes = folder};
  const std::vector<NamedMesh> meshes = user_meshes(settings);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "octahedron");
  EXPECT_TRUE(user_meshes(settings, 5).empty());
  const UserSurfaces surfaces = user_surfaces(settings, 10);
  ASSERT_EQ(surfaces.polygons.size(), 1u);
  EXPECT_EQ(surfaces.polygons[0].name, "square");
  EXPECT_EQ(surfaces.triangles.size(), 1u);
  std::ofstream(folder / "points.xyz") << "0 0 0\n1 0 0\n0 1 0\n";
  const std::vector<NamedCloud> clouds = user_clouds(settings, 3);
  ASSERT_EQ(clouds.size(), 1u);
  EXPECT_EQ(clouds[0].name, "points");
  EXPECT_TRUE(user_clouds(settings, 2).empty());
  for (const Experiment& e : experiments())
    if (e.name == "variants") EXPECT_FALSE(e.run(settings).where("shape", "octahedron").rows().empty());
}

TEST(Report, HoldsWhatWasRunAndItsPlotOrWhyThereIsNone) {
  const io::TemporaryFolder temporary("ahm_test_");
  const auto& folder = temporary.directory();
  RunRecord record(folder);
  const Experiment& first = experiments().front();
  record.run(first, {.toy = true});
  EXPECT_GT(RunRecord(folder).find(first.name)->at("peak_megabytes").get<double>(), 0);
  const Report report = write_report(folder);
  const std::string page = text_of(report.page);
  EXPECT_NE(page.find(std::string(first.title)), std::string::npos);
  EXPECT_NE(page.find("AHM_a"), std::string::npos);
  if (report.problem.empty())
    EXPECT_NE(page.find("<svg"), std::string::npos);
  else
    EXPECT_NE(page.find(report.problem.substr(0, 8)), std::string::npos);
}

TEST(Report, OfNothingIsRefused) {
  const io::TemporaryFolder temporary("ahm_test_");
  EXPECT_THROW(write_report(temporary.directory()), IoError);
  EXPECT_THROW(write_report(temporary.directory() / "nowhere"), IoError);
}

}  // namespace
}  // namespace ahm::bench
