/// \file
/// The few types every part of libahm shares.
#pragma once

#include <array>
#include <cstdint>

namespace ahm {

/// Number of a vertex, point or face. 0-based.
using Index = std::int32_t;

/// Position in an array that may outgrow `Index` (edges, matrix entries).
using Offset = std::int64_t;

/// A point or vector of ambient 3-space.
using Vec3 = std::array<double, 3>;

}  // namespace ahm
