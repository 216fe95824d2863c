/// \file
/// Binary numbers, lowest byte first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace ahm::io {

/// Appends the bytes of a value, lowest first.
template <class T>
void append(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

}  // namespace ahm::io
