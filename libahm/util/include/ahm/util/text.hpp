/// \file
/// Numbers in messages. Not part of the public interface.
#pragma once

#include <cstdio>
#include <string>

namespace ahm::detail {

/// The number with six significant digits.
inline std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

}  // namespace ahm::detail
