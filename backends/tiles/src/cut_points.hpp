/// \file
/// The points of a tile as read from the input.
#pragma once

#include <cstdint>
#include <string_view>

#include "ahm/types.hpp"

namespace ahm::tiles {

inline constexpr std::string_view cut_kind = "cut";

/// A point of the input with its row.
struct CutPoint {
  Vec3 point;        ///< position in the input
  std::int64_t row;  ///< row in the input
};
static_assert(sizeof(CutPoint) == 32);

}  // namespace ahm::tiles
