// The law of units: every subcommand gives the same result at every scale of doubles, multiplied by the scale.
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "program.hpp"
#include "shapes.hpp"

namespace ahm::test {
namespace {

/// Powers of two from 1e-300 to 1e300. Multiplication by them is exact.
constexpr int exponents[] = {-996, -664, -531, 531, 664, 996};

/// Positions or lengths at some scale: numbers separated by commas, positions by blanks.
std::string at(double scale, const std::vector<std::vector<double>>& positions) {
  std::ostringstream text;
  text.precision(17);
  for (const auto& position : positions)
    for (std::size_t c = 0; c < position.size(); ++c)
      text << position[c] * scale << (c + 1 < position.size() ? "," : &position == &positions.back() ? "" : " ");
  return "'" + text.str() + "'";
}

/// A bent sheet of 13 x 13 points in [0, 1]^2: triangles, quads, or a cloud.
struct Sheet {
  const char* file;
  std::string (*text)(double scale);
};

constexpr int side = 13;

Vec3 bent(double x, double y) { return {x, y, 0.2 * std::sin(3 * x) * std::cos(2 * y)}; }

Points points_at(double scale) {
  Points points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      points.push_back(bent((i + 0.2 * std::sin(5.0 * i * j)) / (side - 1), j / (side - 1.0)));
  return moved(points, {0, 0, 0}, scale);
}

constexpr Sheet sheets[] = {{"triangles.obj", [](double scale) { return obj(points_at(scale), cells(side, true)); }},
                            {"quads.obj", [](double scale) { return obj(points_at(scale), cells(side)); }},
                            {"cloud.xyz", [](double scale) {
                               Points twins;  // of some points, much nearer than all other neighbors
                               for (int k = 5; k < side; k += 3)
                                 twins.push_back(bent((k + 0.01) / (side - 1), (k - 2.99) / (side - 1)));
                               return xyz(joined(points_at(scale), moved(twins, {0, 0, 0}, scale)));
                             }}};

using Arguments = std::function<std::string(double scale)>;

class Scales : public InFolder {
 protected:
  /// Expects b = a * scale to rounding, or NaN in both.
  static void expect_scaled(double a, double b, double scale, const std::string& what) {
    if (std::isnan(a) || std::isnan(b))
      EXPECT_EQ(std::isnan(a), std::isnan(b)) << what << ": " << a << ", " << b;
    else
      EXPECT_NEAR(a, b / scale, 1e-12 * (1 + std::abs(a))) << what;
  }

  static void expect_scaled(const std::vector<Row>& a, const std::vector<Row>& b, double scale) {
    const std::set<std::string> lengths{"x",         "y",      "z", "u", "v", "distance", "spread", "error_estimate",
                                        "arclength", "spacing"};
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t r = 0; r < a.size(); ++r)
      for (const auto& [name, value] : a[r].numbers) {
        const bool is_direction = name == "angle" || name == "gx" || name == "gy" || name == "gz";
        if (is_direction && std::hypot(a[r]["u"], a[r]["v"]) < 1e-8) continue;  // the source has none
        expect_scaled(value, b[r][name], lengths.contains(name) ? scale : 1, name);
        if (HasFailure()) return;
      }
  }

  /// Runs a subcommand on sheets at all scales, and expects the same table.
  static void expect_same_tables(const std::string& command, const Arguments& arguments,
                                 const std::vector<int>& on = {0, 1, 2}) {
    for (const int k : on) {
      const auto table_at = [&](double scale) {
        write(sheets[k].file, sheets[k].text(scale));
        return table(command + " " + sheets[k].file + " " + arguments(scale));
      };
      const auto expected = table_at(1);
      ASSERT_FALSE(expected.empty());
      for (const int exponent : exponents) {
        SCOPED_TRACE(command + " on " + sheets[k].file + " at 2^" + std::to_string(exponent));
        const double scale = std::ldexp(1.0, exponent);
        expect_scaled(expected, table_at(scale), scale);
        if (HasFailure()) return;
      }
    }
  }

  /// Runs a subcommand on all sheets at all scales, and expects the same numbers in its summary.
  static void expect_same_summaries(const std::string& command, const Arguments& arguments, const Words& lengths,
                                    const Words& ratios) {
    for (const Sheet& sheet : sheets) {
      const auto summary_at = [&](double scale) {
        write(sheet.file, sheet.text(scale));
        return summary(command + " " + sheet.file + " " + arguments(scale));
      };
      const auto expected = summary_at(1);
      for (const int exponent : exponents) {
        SCOPED_TRACE(command + " on " + sheet.file + " at 2^" + std::to_string(exponent));
        const double scale = std::ldexp(1.0, exponent);
        const auto found = summary_at(scale);
        for (const std::string& name : lengths) expect_scaled(number(expected, name), number(found, name), scale, name);
        for (const std::string& name : ratios) expect_scaled(number(expected, name), number(found, name), 1, name);
      }
    }
  }
};

std::string nothing(double) { return ""; }

TEST_F(Scales, DoNotMatterToMaps) {
  expect_same_tables("logmap --source 40", nothing);
  expect_same_tables("logmap --method heat --source 40", [](double s) { return "--radius " + at(s, {{0.5}}); });
  expect_same_tables("logmap --strategy march --gradient", [](double s) {
    return "--source " + at(s, {{0.4, 0.3, 0.1}}) + " --u-axis " + at(s, {{0.3, 0.2, 0.1}});
  });
  expect_same_tables("logmap --local --source 40", [](double s) { return "--radius " + at(s, {{0.3}}); });
  expect_same_tables("logmap --source face:70:.5,.3,.2", nothing, {0});
  expect_same_tables("logmap --source face:70:.4,.3,.2,.1", nothing, {1});
}

TEST_F(Scales, DoNotMatterToStraightLines) {
  expect_same_tables("logmap --method exact --source 40", nothing, {0, 1});
  expect_same_tables("path --from 7", [](double s) { return "--to " + at(s, {{0.8, 0.3, 0.2}}); }, {0, 1});
  expect_same_tables("trace --source 40 --direction 1,0.3,0", [](double s) { return "--length " + at(s, {{0.4}}); },
                     {0, 1});
}

TEST_F(Scales, DoNotMatterToCurves) {
  const auto curve = [](double s) { return "--curve " + at(s, {{0.3, 0.05, 0.1}, {0.6, 0.35, 0.1}, {0.9, 0.65, 0}}); };
  expect_same_tables("stroke", curve);
  expect_same_tables("stroke --method exact", curve, {0, 1});
}

TEST_F(Scales, DoNotMatterToToolPathsAndCells) {
  for (const std::string pattern : {"raster", "spiral"})
    expect_same_tables("coverage --source 84 --pattern " + pattern,
                       [](double s) { return "--radius " + at(s, {{0.35}}) + " --spacing " + at(s, {{0.06}}); });
  expect_same_tables("inverse --source 84", [](double s) {
    return "--at " + at(s, {{0, 0}, {0.1, 0.05}, {-0.2, 0.1}});
  });
  expect_same_tables("cells --count 5", nothing);
}

TEST_F(Scales, DoNotMatterToCenters) {
  for (const std::string median : {"", " --median"})
    expect_same_summaries("center --points '20 60 130'" + median, nothing,
                          {"/center/spread", "/center/position/0", "/center/position/1", "/center/position/2"}, {});
}

TEST_F(Scales, DoNotMatterToAtlasesAndDecals) {
  write("image.obj", sheets[0].text(1));
  run_ok("logmap image.obj --source 3 -o a.csv --view a.png --size 64x32");
  expect_same_summaries("atlas --max-distortion 1.05 --charts 3 --size 256 -o a.obj", nothing, {},
                        {"/distortion/mean", "/distortion/median", "/distortion/percentile_95", "/distortion/largest",
                         "/distortion/flipped_area", "/texture/filled"});
  expect_same_summaries("decal --source 84 --image a.png -o d.obj",
                        [](double s) { return "--size " + at(s, {{0.5}}) + " --radius " + at(s, {{0.2}}); }, {},
                        {"/covered", "/distortion/mean"});
}

TEST_F(Scales, BeyondSinglePrecisionAreRejectedByFormatsThatNeedIt) {
  for (const double scale : {1e-200, 1e200}) {
    write("sheet.obj", sheets[0].text(scale));
    expect_refused("atlas sheet.obj", {{"--charts 3 --size 256 -o a.glb", 1, {"single precision"}}});
  }
}

TEST_F(Scales, WithoutSquaresInDoublesHaveNoAreas) {
  for (const double scale : {1e-160, 1e-100, 1.0, 1e100, 1e160}) {
    const bool has_areas = scale > 1e-150 && scale < 1e150;
    write("sheet.obj", sheets[0].text(scale));
    const auto json = summary("cells sheet.obj --count 3 -o c.csv");
    EXPECT_EQ(json.at("largest_area").is_number(), has_areas);
    EXPECT_EQ(json.at("warnings").empty(), has_areas);
    if (has_areas) EXPECT_NEAR(number(json, "/largest_area") / scale / scale, 0.4, 0.3);
  }
}

}  // namespace
}  // namespace ahm::test
