/// \file
/// Numbers as people type them, with a point whatever the locale, parsed strictly: the whole text, finite, in range.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/types.hpp"

namespace ahm::app {

/// A finite number.
/// @throws std::invalid_argument saying what is wrong with the text
double parse_number(std::string_view text);

/// A finite number > 0.
/// @throws std::invalid_argument
double parse_positive(std::string_view text);

/// A finite number of degrees, as radians.
/// @throws std::invalid_argument
double parse_degrees(std::string_view text);

/// A whole number in [low, high].
/// @throws std::invalid_argument
std::int64_t parse_integer(std::string_view text, std::int64_t low,
                           std::int64_t high = std::numeric_limits<Index>::max());

/// Finite numbers separated by commas, one at the least.
/// @throws std::invalid_argument
std::vector<double> parse_numbers(std::string_view text);

/// Three finite numbers separated by commas.
/// @throws std::invalid_argument
Vec3 parse_triple(std::string_view text);

/// Three finite numbers separated by commas, not all zero.
/// @throws std::invalid_argument
Vec3 parse_direction(std::string_view text);

}  // namespace ahm::app
