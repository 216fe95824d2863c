/// \file
/// Colors that stand in a file as plain numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::io {

using Color = std::array<std::uint8_t, 3>;

/// Red, green, blue as fractions of 1 (when none exceeds 1), else as whole levels up to 255, else, where `deep`, as whole
/// levels up to 65535. nullopt when they are none of these.
std::optional<std::vector<Color>> to_colors(const std::vector<Vec3>& values, bool deep = false);

}  // namespace ahm::io
