/// \file
/// Little-endian binary numbers.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace ahm::io {

/// Appends the bytes of a value, least significant byte first.
template <class T>
void append(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

/// The value at a position. Does not check the bounds of `bytes`.
template <class T>
T load_at(std::string_view bytes, std::size_t position) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + position, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  return std::bit_cast<T>(raw);
}

}  // namespace ahm::io
