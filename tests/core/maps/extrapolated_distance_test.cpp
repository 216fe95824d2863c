// Distances of heat at order 2: extrapolated where they are smooth in sqrt(tau), those of the shortest time elsewhere.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "maps/extrapolate.hpp"

namespace ahm {
namespace {

/// A vertex at `distances` at three times; phi, along the first axis, agrees with them, and so do spreads unless given.
double extrapolated(const std::array<double, 3>& distances, double c, double path, double last_spread = NAN) {
  std::array<std::array<double, 2>, 3> phi{};
  for (std::size_t k = 0; k < 3; ++k) phi[k][0] = distances[k];
  std::array<TimedRow, 3> rows{};
  for (std::size_t k = 0; k < 3; ++k) rows[k] = {Status::ok, phi[k], distances[k], 0.1};
  rows[2].spread = std::isnan(last_spread) ? 0.1 * std::pow(2 * c, 0.25) : last_spread;
  std::array<double, 2> out{};
  return extrapolate_row(rows, {1, c, 0.1}, {.unfolded = false, .of_curve = false}, path, INFINITY, out).distance;
}

/// `limit` + `slope` sqrt(tau): of the times 1, c and 2 c.
std::array<double, 3> smooth(double limit, double slope, double c) {
  return {limit + slope, limit + slope * std::sqrt(c), limit + slope * std::sqrt(2 * c)};
}

TEST(ExtrapolatedDistance, IsTheLimitWhereItIsSmooth) {
  for (double c : {1.0, 2.0, 4.0})
    for (double slope : {-0.02, 0.0, 0.02}) EXPECT_NEAR(extrapolated(smooth(3, slope, c), c, 3.2), 3, 1e-12);
}

TEST(ExtrapolatedDistance, IsThatOfTheShortestTimeWhereTheLimitIsFarAway) {
  for (double slope : {-0.3, 0.35}) EXPECT_EQ(extrapolated(smooth(3, slope, 1), 1, 3.2 + slope), 3 + slope);
}

TEST(ExtrapolatedDistance, IsThatOfTheShortestTimeWhereWaysSpreadOtherwiseThanOnSmoothSurfaces) {
  for (double c : {1.0, 4.0})
    for (double times : {0.8, 1.3})
      EXPECT_EQ(extrapolated(smooth(3, 0.02, c), c, 3.2, times * 0.1 * std::pow(2 * c, 0.25)), 3.02);
}

TEST(ExtrapolatedDistance, IsThatOfTheShortestTimeWhereEdgesDoNotFollowTheWay) {
  EXPECT_EQ(extrapolated(smooth(3, 0.02, 1), 1, 1.2 * 3.02), 3.02);
}

TEST(ExtrapolatedDistance, IsThatOfTheShortestTimeWhereLimitsDisagree) {
  std::array<double, 3> rough = smooth(3, 0.02, 4);
  rough[0] = 3.01;  // the times 1 and 4 have another limit, 2.98
  EXPECT_EQ(extrapolated(rough, 4, 3.2), 3.01);
}

}  // namespace
}  // namespace ahm
