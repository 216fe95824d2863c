#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "program.hpp"

namespace ahm::test {
namespace {

TEST(Info, CountsWhatIsThere) {
  Folder folder;
  auto points = plane(20);
  points.push_back(points[3]);
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const auto input = folder.write("plane.xyz", xyz(points));
  const auto outcome = run({"info", input, "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("points"), points.size());
  EXPECT_EQ(json.at("faces"), 0);
  EXPECT_EQ(json.at("normals"), false);
  EXPECT_EQ(json.at("duplicates"), 1);
  EXPECT_EQ(json.at("non_finite"), 1);
  EXPECT_EQ(json.at("components"), 1);
  const auto& spacing = json.at("spacing");
  EXPECT_GT(spacing.at("smallest").get<double>(), 0.0);
  EXPECT_LE(spacing.at("smallest").get<double>(), spacing.at("median").get<double>());
  EXPECT_LE(spacing.at("median").get<double>(), spacing.at("largest").get<double>());
  EXPECT_LT(spacing.at("largest").get<double>(), 0.1);
  EXPECT_NE(json.at("suggestion").get<std::string>().find("--drop-nan"), std::string::npos);
}

TEST(Info, SuggestsACommandThatWorks) {
  Folder folder;
  const auto input = folder.write("sphere.xyz", xyz(sphere(1000)));
  const auto json = nlohmann::json::parse(run({"info", input, "--json", "-"}).out);
  std::istringstream words(json.at("suggestion").get<std::string>());
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  ASSERT_EQ(arguments.at(0), "ahm");
  arguments.erase(arguments.begin());
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i)
    if (arguments[i] == "-o" || arguments[i] == "--view") arguments[i + 1] = folder / arguments[i + 1];
  const auto outcome = run(arguments);
  const bool lacks_pictures = outcome.err.find("this build of ahm cannot write") != std::string::npos;
  EXPECT_TRUE(outcome.status == 0 || lacks_pictures) << outcome.err;
}

TEST(Info, SpeaksToPeopleToo) {
  Folder folder;
  const auto outcome = run({"info", folder.write("sphere.xyz", xyz(sphere(500), sphere(500)))});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"points", "normals", "bounds", "spacing", "components", "ahm logmap"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
}

TEST(Info, NamesTheProblemOfACloudThatCannotBeMapped) {
  Folder folder;
  for (const std::string cloud : {"0 0 0\n1 0 0\n", "0 0 0\n1 0 0\n2 0 0\n3 0 0\n"}) {
    const auto outcome = run({"info", folder.write("line.xyz", cloud), "--json", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_FALSE(json.at("problem").get<std::string>().empty());
    EXPECT_EQ(json.at("suggestion"), "");
  }
}

TEST(Info, CountsComponents) {
  Folder folder;
  auto points = plane(20);
  for (Vec3 p : plane(10)) points.push_back({p[0] + 40, p[1], p[2]});
  const auto json = nlohmann::json::parse(run({"info", folder.write("two.xyz", xyz(points)), "--json", "-"}).out);
  EXPECT_EQ(json.at("components"), 2);
  EXPECT_EQ(json.at("component_sizes"), (std::vector<int>{400, 100}));
  EXPECT_LT(json.at("central_point").get<int>(), 400);
}

}  // namespace
}  // namespace ahm::test
