/// \file
/// Lines on the unit sphere beside great circles: how errors fall.
#pragma once

#include <gtest/gtest.h>

namespace ahm::test {

/// The largest of some paths, and of some traces of length 2.
struct LineErrors {
  double length = 0;      ///< of paths, relative
  double off_circle = 0;  ///< of the points of paths
  double trace = 0;       ///< of the ends of traces
};

/// @param fine  of a quarter of the spacing
inline void expect_convergence(const LineErrors& coarse, const LineErrors& fine) {
  EXPECT_LT(fine.length, coarse.length / 12);         // of second order
  EXPECT_LT(fine.off_circle, coarse.off_circle / 4);  // between first and second
  EXPECT_LT(fine.trace, coarse.trace / 4);
}

}  // namespace ahm::test
