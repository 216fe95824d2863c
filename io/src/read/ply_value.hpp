/// \file
/// Values in the body of a binary PLY file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "read/ply_header.hpp"

namespace ahm::io {

/// Whether the bytes of its values stand in the other order than in memory.
inline bool is_swapped(PlyFormat format) noexcept {
  return (format == PlyFormat::big_endian) != (std::endian::native == std::endian::big);
}

template <class T>
double load_as(const char* bytes, bool swap) noexcept {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::ranges::reverse(raw);
  return static_cast<double>(std::bit_cast<T>(raw));
}

inline double load_value(PlyType type, const char* bytes, bool swap) noexcept {
  switch (type) {
    case PlyType::int8:
      return load_as<std::int8_t>(bytes, swap);
    case PlyType::uint8:
      return load_as<std::uint8_t>(bytes, swap);
    case PlyType::int16:
      return load_as<std::int16_t>(bytes, swap);
    case PlyType::uint16:
      return load_as<std::uint16_t>(bytes, swap);
    case PlyType::int32:
      return load_as<std::int32_t>(bytes, swap);
    case PlyType::uint32:
      return load_as<std::uint32_t>(bytes, swap);
    case PlyType::float32:
      return load_as<float>(bytes, swap);
    case PlyType::float64:
      return load_as<double>(bytes, swap);
  }
  return 0.0;
}

}  // namespace ahm::io
