// The law of units: every subcommand gives the same at every scale that doubles hold, up to that scale.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <utility>

#include "ahm/conformance/triangle_meshes.hpp"
#include "program.hpp"

namespace ahm::test {
namespace {

using Words = std::vector<std::string>;

/// Powers of two from 1e-300 to 1e300: scaling by them loses nothing.
constexpr int exponents[] = {-996, -664, -531, 531, 664, 996};

/// A length, or several after each other, at some scale.
std::string words(double scale, std::initializer_list<double> lengths, const char* between = ",") {
  std::ostringstream text;
  text.precision(17);
  for (bool first = true; double x : lengths) text << (std::exchange(first, false) ? "" : between) << x * scale;
  return text.str();
}

/// A bent sheet in [0, 1]^2 as a file at some scale.
struct Sheet {
  std::string ending;
  std::string (*text)(double scale);
};

constexpr int side = 13;

double bent(double x, double y) { return 0.2 * std::sin(3 * x) * std::cos(2 * y); }

std::string points_of(double scale) {
  std::string text;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double x = (i + 0.2 * std::sin(5.0 * i * j)) / (side - 1), y = j / (side - 1.0);
      text += words(scale, {x, y, bent(x, y)}, " ") + "\n";
    }
  return text;
}

std::string faces_of(double scale, bool triangles) {
  std::ostringstream text;
  text << "OFF\n" << side * side << ' ' << (side - 1) * (side - 1) * (triangles ? 2 : 1) << " 0\n" << points_of(scale);
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      const int a = i * side + j, b = a + side, c = b + 1, d = a + 1;
      if (triangles)
        text << "3 " << a << ' ' << b << ' ' << c << "\n3 " << a << ' ' << c << ' ' << d << '\n';
      else
        text << "4 " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
    }
  return text.str();
}

/// Some points have a twin, much nearer than all other neighbours.
std::string cloud_of(double scale) {
  std::string text = points_of(scale);
  for (int k = 5; k < side; k += 3) {
    const double x = (k + 0.01) / (side - 1), y = (k - 2.99) / (side - 1);
    text += words(scale, {x, y, bent(x, y)}, " ") + "\n";
  }
  return text;
}

constexpr Sheet sheets[] = {
    {".off", [](double scale) { return faces_of(scale, true); }},
    {".off", [](double scale) { return faces_of(scale, false); }},
    {".xyz", cloud_of},
};

/// Expects b = a * scale to rounding, or both NaN.
void expect_scaled(double a, double b, double scale, const std::string& what) {
  if (std::isnan(a) || std::isnan(b))
    EXPECT_EQ(std::isnan(a), std::isnan(b)) << what << ": " << a << ", " << b;
  else
    EXPECT_NEAR(a, b / scale, 1e-12 * (1 + std::abs(a))) << what;
}

void expect_scaled_table(const std::vector<NumberRow>& a, const std::vector<NumberRow>& b, double scale,
                         const std::string& what) {
  const std::set<std::string> lengths{"x",         "y",      "z", "u", "v", "distance", "spread", "error_estimate",
                                      "arclength", "spacing"};
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t r = 0; r < a.size(); ++r)
    for (const auto& [name, value] : a[r]) {
      const bool direction = name == "angle" || name == "gx" || name == "gy" || name == "gz";
      if (direction && std::hypot(a[r].at("u"), a[r].at("v")) < 1e-8) continue;  // the source has none
      expect_scaled(value, b[r].at(name), lengths.contains(name) ? scale : 1, what + ", " + name);
      if (testing::Test::HasFailure()) return;
    }
}

/// Runs a subcommand on every sheet at all scales; its table must be the same.
/// @param arguments  those besides input and output
void expect_same_at_all_scales(const Words& command, const std::function<Words(double scale)>& arguments,
                               std::initializer_list<int> on = {0, 1, 2}) {
  const Folder folder;
  const auto table = [&](const Sheet& sheet, int exponent) {
    const double scale = std::ldexp(1.0, exponent);
    Words all = command;
    all.insert(all.begin() + 1, folder.write("sheet" + sheet.ending, sheet.text(scale)));
    for (const std::string& word : arguments(scale)) all.push_back(word);
    all.insert(all.end(), {"-o", folder / "out.csv"});
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.status, 0) << command[0] << " at 2^" << exponent << ": " << outcome.err;
    return outcome.status == 0 ? read_numbers(folder / "out.csv") : std::vector<NumberRow>{};
  };
  for (int k : on) {
    const auto expected = table(sheets[k], 0);
    ASSERT_FALSE(expected.empty());
    for (int exponent : exponents) {
      expect_scaled_table(expected, table(sheets[k], exponent), std::ldexp(1.0, exponent),
                          command[0] + " on sheet " + std::to_string(k) + " at 2^" + std::to_string(exponent));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(Scales, DoNotMatterToMaps) {
  expect_same_at_all_scales({"logmap", "--source", "40"}, [](double) { return Words{}; });
  expect_same_at_all_scales({"logmap", "--method", "heat", "--source", "40"}, [](double s) {
    return Words{"--radius", words(s, {0.5})};
  });
  expect_same_at_all_scales({"logmap", "--strategy", "march", "--gradient"}, [](double s) {
    return Words{"--source", words(s, {0.4, 0.3, 0.1}), "--u-axis", words(s, {0.3, 0.2, 0.1})};
  });
}

TEST(Scales, DoNotMatterToWhatIsBuiltOfTheSurroundings) {
  expect_same_at_all_scales({"logmap", "--local", "--source", "40"}, [](double s) {
    return Words{"--radius", words(s, {0.3})};
  });
}

TEST(Scales, DoNotMatterToSourcesInFaces) {
  expect_same_at_all_scales({"logmap", "--source", "face:70:.5,.3,.2"}, [](double) { return Words{}; }, {0});
  expect_same_at_all_scales({"logmap", "--source", "face:70:.4,.3,.2,.1"}, [](double) { return Words{}; }, {1});
}

TEST(Scales, DoNotMatterToStraightLines) {
  expect_same_at_all_scales({"logmap", "--method", "exact", "--source", "40"}, [](double) { return Words{}; }, {0, 1});
  expect_same_at_all_scales({"path", "--from", "7"},
                            [](double s) {
                              return Words{"--to", words(s, {0.8, 0.3, 0.2})};
                            },
                            {0, 1});
  expect_same_at_all_scales({"trace", "--source", "40", "--direction", "1,0.3,0"},
                            [](double s) {
                              return Words{"--length", words(s, {0.4})};
                            },
                            {0, 1});
}

TEST(Scales, DoNotMatterToCurves) {
  const auto curve = [](double s) {
    return Words{"--curve",
                 words(s, {0.3, 0.05, 0.1}) + " " + words(s, {0.6, 0.35, 0.1}) + " " + words(s, {0.9, 0.65, 0})};
  };
  expect_same_at_all_scales({"stroke"}, curve);
  expect_same_at_all_scales({"stroke", "--method", "exact"}, curve, {0, 1});
}

TEST(Scales, DoNotMatterToPathsOfTools) {
  for (const char* pattern : {"raster", "spiral"})
    expect_same_at_all_scales({"coverage", "--source", "84", "--pattern", pattern}, [](double s) {
      return Words{"--radius", words(s, {0.35}), "--spacing", words(s, {0.06})};
    });
}

TEST(Scales, DoNotMatterToPointsLookedUp) {
  expect_same_at_all_scales({"inverse", "--source", "84"}, [](double s) {
    return Words{"--at", words(s, {0, 0}) + " " + words(s, {0.1, 0.05}) + " " + words(s, {-0.2, 0.1})};
  });
}

TEST(Scales, DoNotMatterToCells) {
  expect_same_at_all_scales({"cells", "--count", "5"}, [](double) { return Words{}; });
}

/// The numbers of a summary at some scale.
nlohmann::json summary_of(const Folder& folder, const Sheet& sheet, double scale, Words command) {
  command.insert(command.begin() + 1, folder.write("sheet" + sheet.ending, sheet.text(scale)));
  command.insert(command.end(), {"--json", folder / "out.json"});
  const Outcome outcome = run(command);
  EXPECT_EQ(outcome.status, 0) << command[0] << " at " << scale << ": " << outcome.err;
  return outcome.status == 0 ? read_json(folder / "out.json") : nlohmann::json();
}

TEST(Scales, DoNotMatterToCenters) {
  const Folder folder;
  for (const Sheet& sheet : sheets)
    for (const char* which : {"--points", "--median"}) {
      const Words command{"center", "--points", "20 60 130", which == std::string("--median") ? which : "--verbose"};
      const auto expected = summary_of(folder, sheet, 1, command).at("center");
      for (int exponent : exponents) {
        const double scale = std::ldexp(1.0, exponent);
        const auto found = summary_of(folder, sheet, scale, command).at("center");
        expect_scaled(expected.at("spread"), found.at("spread"), scale, "spread");
        for (std::size_t c = 0; c < 3; ++c)
          expect_scaled(expected.at("position")[c], found.at("position")[c], scale, "position");
      }
    }
}

TEST(Scales, DoNotMatterToAtlasesAndDecals) {
  const Folder folder;
  const std::string view = folder / "a.png";
  {  // an image, as the program draws them
    const std::string input = folder.write("image.off", faces_of(1, true));
    ASSERT_EQ(run({"logmap", input, "--source", "3", "-o", folder / "a.csv", "--view", view, "--size", "64x32"}).status,
              0);
  }
  for (const Sheet& sheet : sheets) {
    const auto atlas = [&](double scale) {
      return summary_of(
          folder, sheet, scale,
          {"atlas", "--max-distortion", "1.05", "--charts", "3", "--size", "256", "-o", folder / "a.obj"});
    };
    const auto decal = [&](double scale) {
      return summary_of(folder, sheet, scale,
                        {"decal", "--source", "84", "--image", view, "--size", words(scale, {0.5}), "-o",
                         folder / "d.obj", "--radius", words(scale, {0.2})});
    };
    const auto of_atlas = atlas(1), of_decal = decal(1);
    for (int exponent : exponents) {
      const double scale = std::ldexp(1.0, exponent);
      const auto a = atlas(scale), d = decal(scale);
      for (const char* name : {"mean", "median", "percentile_95", "largest", "flipped_area"})
        expect_scaled(of_atlas.at("distortion").at(name), a.at("distortion").at(name), 1, name);
      expect_scaled(of_atlas.at("texture").at("filled"), a.at("texture").at("filled"), 1, "filled");
      expect_scaled(of_decal.at("covered"), d.at("covered"), 1, "covered");
      expect_scaled(of_decal.at("distortion").at("mean"), d.at("distortion").at("mean"), 1, "mean");
    }
  }
}

TEST(Scales, ThatSinglePrecisionDoesNotHoldAreRefusedByItsFormat) {
  const Folder folder;
  for (double scale : {1e-200, 1e200}) {
    const std::string input = folder.write("sheet.off", faces_of(scale, true));
    const Outcome outcome = run({"atlas", input, "--charts", "3", "--size", "256", "-o", folder / "a.glb"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("single precision"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(folder.files(), std::vector<std::string>{"sheet.off"});
}

TEST(Scales, WhoseSquaresNoDoubleHoldsHaveNoAreas) {
  const Folder folder;
  for (double scale : {1e-160, 1e-100, 1.0, 1e100, 1e160}) {
    const bool known = scale > 1e-150 && scale < 1e150;
    const auto j = summary_of(folder, sheets[0], scale, {"cells", "--count", "3", "-o", folder / "c.csv"});
    EXPECT_EQ(j.at("largest_area").is_number(), known);
    EXPECT_EQ(j.at("warnings").empty(), known);
    if (known) EXPECT_NEAR(j.at("largest_area").get<double>() / scale / scale, 0.4, 0.3);
  }
}

}  // namespace
}  // namespace ahm::test
