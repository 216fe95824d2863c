/// \file
/// In which unit a file may count lengths. Hardly any format says so.
#pragma once

#include <string>
#include <string_view>

#include "ahm/types.hpp"

namespace ahm::app {

struct UnitGuess {
  std::string_view unit;  ///< empty: none
  std::string_view reason;
};

/// @param format     as `io::Geometry::format`
/// @param low, high  bounds of the points
UnitGuess guess_unit(std::string_view format, const Vec3& low, const Vec3& high);

}  // namespace ahm::app
