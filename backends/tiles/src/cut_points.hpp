/// \file
/// Points of a tile as they were cut from the input.
#pragma once

#include <cstdint>
#include <string_view>

#include "ahm/types.hpp"

namespace ahm::tiles {

inline constexpr std::string_view cut_kind = "cut";

struct CutPoint {
  Vec3 point;        ///< as in the input
  std::int64_t row;  ///< there
};
static_assert(sizeof(CutPoint) == 32);

}  // namespace ahm::tiles
