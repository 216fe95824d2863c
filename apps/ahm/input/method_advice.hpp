/// \file
/// Which method suits a surface.
#pragma once

#include <string>

#include "ahm/surface/surface.hpp"

namespace ahm::app {

/// The method, and what speaks for exact maps instead.
struct MethodAdvice {
  Method method = Method::heat;  ///< `Surface::suggested_method`
  bool exact_possible = false;
  std::string problem;  ///< why not
  /// Angles in degrees between the faces at an edge: half of the edges bend less, 5 % bend more.
  double median_bend = 0, sharp_bend = 0;
  bool exact_first = false;  ///< for single maps
};

/// Exact maps cost no more than a first one by heat up to `exact_vertices`, and other methods' vectors are as near on surfaces that
/// are sampled finely and smoothly (docs/results/exact.md).
MethodAdvice method_advice(const Surface& surface);

inline constexpr Index exact_vertices = 50000;
/// In degrees: where 5 % of the edges bend more, the surface is coarse or has sharp edges.
inline constexpr double fine_bend = 5;

std::string as_text(const MethodAdvice& advice);

}  // namespace ahm::app
