// Exact and polar maps.
#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

class Methods : public InFolder {
 protected:
  Methods() {
    write("square.obj", obj(flat_square(15)));
    write("cube.off", cube_and_square);
    write("sphere.obj", obj(icosphere(12)));
    write("plane.xyz", xyz(plane(12)));
  }
};

TEST_F(Methods, AreTheSameOnAPlaneInEverySubcommand) {
  std::map<std::string, Words> cases{{"stroke square.obj --curve '0.2,0.3,0 0.8,0.6,0'", {"u", "v", "distance"}},
                                     {"cells square.obj --sources '17 100 201'", {"distance"}}};
  for (const std::string source : {"square.obj -s 112", "square.obj -s face:40:.2,.3,.5"}) {
    cases["logmap --gradient " + source] = {"u", "v", "distance", "quality"};
    cases["inverse --at '0.1,0.1 -.2,.15' " + source] = {"x", "y", "z", "hx", "hy", "hz"};
    cases["coverage --radius .2 --spacing .05 " + source] = {"x", "y", "z", "arclength"};
  }
  for (const auto& [command, columns] : cases) {
    const std::string other = command.starts_with("cells") ? " --method wavefront" : " --method heat";
    const auto heat = table(command + other), exact = table(command + " --method exact");
    ASSERT_EQ(heat.size(), exact.size()) << command;
    ASSERT_FALSE(heat.empty());
    for (std::size_t i = 0; i < heat.size(); ++i)
      for (const std::string& column : columns) ASSERT_NEAR(heat[i][column], exact[i][column], 1e-9) << command;
  }
  for (const std::string median : {"", " --median"}) {
    const auto center = [&](const std::string& method) -> Vec3 {
      return summary("center square.obj --points '20 130 201' --method " + method + median).at("center").at("position");
    };
    EXPECT_LT(distance(center("heat"), center("exact")), 1e-9);
  }
}

TEST_F(Methods, UnfoldACubeIfExact) {
  const double root2 = std::sqrt(2.0), lengths[] = {0, 1, 1, root2, 1, root2, root2, std::sqrt(5.0)};
  const auto json = summary("logmap cube.off --source 0 --method exact -o map.csv");
  expect_values(json, {{"/method", "exact"}});
  EXPECT_FALSE(json.contains("variant") || json.contains("strategy") || json.contains("t_coef"));
  const auto map = read_csv("map.csv"), cells = table("cells cube.off --sources '0 7' --method exact");
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(map.at(k)["distance"], lengths[k], 1e-12);
    EXPECT_NEAR(cells.at(k)["distance"], k == 0 || k == 7 ? 0 : 1, 1e-12);
    EXPECT_EQ(cells[k]["label"], k == 0 || k == 1 || k == 2 || k == 4 ? 0 : 1);
  }
}

TEST_F(Methods, MakeAtlasesAndCenters) {
  const auto json = summary("atlas square.obj --charts 5 --method exact -o atlas.obj");
  expect_values(json, {{"/uncharted", 0}});
  EXPECT_NEAR(number(json, "/distortion/largest"), 1, 1e-9);
  for (const std::string backend : {"", " --backend pointcloud"}) {
    run_ok("atlas sphere.obj --charts 12 --method polar -o atlas.obj" + backend);
    run_ok("center sphere.obj --points '3 40 77' --method polar" + backend);
  }
}

TEST_F(Methods, ArePolarByDefault) {
  const auto map = [](const std::string& options) { return summary("logmap sphere.obj -s 0 -o map.csv " + options); };
  for (const auto& [options, method] :
       std::map<std::string, std::string>{{"--method exact", "exact"},
                                          {"--method polar", "polar"},
                                          {"--method heat", "heat"},
                                          {"--t-coef 2", "heat"},
                                          {"--backend pointcloud", "polar"},
                                          {"--backend pointcloud --method polar", "polar"}})
    expect_values(map(options), {{"/method", method}});
  EXPECT_FALSE(map("--method heat").contains("median_error_estimate"));
  map("--method exact");
  const auto exact = read_csv("map.csv");
  const auto json = map("");
  expect_values(json, {{"/method", "polar"}, {"/bounded", 0}});
  EXPECT_TRUE(json.contains("median_error_estimate"));
  EXPECT_FALSE(json.contains("variant") || json.contains("strategy"));
  const auto polar = read_csv("map.csv");
  ASSERT_EQ(polar.size(), exact.size());
  for (std::size_t i = 0; i < polar.size(); ++i) {
    for (const char* name : {"u", "v", "distance"}) EXPECT_NEAR(polar[i][name], exact[i][name], 1e-9);
    EXPECT_EQ(polar[i]["error_estimate"], 0);  // windows cover so small a mesh
  }
}

TEST_F(Methods, ThatAreExactNeedFlatFaces) {
  for (const std::string input : {"plane.xyz", "square.obj --backend pointcloud", "cube.off --discretization polygons"})
    expect_refused("logmap " + input, {{"-s 0 --method exact -o map.csv", 1, {"--method heat"}}});
}

TEST_F(Methods, ThatAreExactHaveNoOptionsOfHeat) {
  for (const std::string option :
       {"--variant adaptive", "--strategy auto", "--t-coef 1", "--ordering amd", "--factor own", "--accuracy 1e-6"}) {
    const std::string name = option.substr(0, option.find(' ')), command = "logmap square.obj -s 0 " + option;
    expect_refused(command, {{"-o map.csv --method exact", 2, {name}}});
    run_ok(command + " -o heat.csv --method heat");
  }
  expect_refused("logmap sphere.obj -s 0 -o map.csv",
                 {{"--method polar --t-coef 2", 2, {"polar does not use --t-coef"}}});
}

}  // namespace
}  // namespace ahm::test
