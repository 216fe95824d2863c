/// \file
/// One vertex for points at the same place.
#pragma once

#include <span>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::io {

struct Welded {
  std::vector<Index> number;  ///< per point
  std::vector<Index> first;   ///< per number: the first point that has it, ascending
};

/// Gives points at exactly equal positions one number. NaN equals nothing, itself included.
Welded weld(std::span<const Vec3> points);

}  // namespace ahm::io
