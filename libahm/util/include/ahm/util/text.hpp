/// \file
/// Formats numbers for messages. Not part of the public interface.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace ahm::detail {

/// The number with six significant digits.
inline std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

/// Formats a number of bytes as "1.23 GB".
inline std::string gigabytes(double bytes) { return number(std::round(bytes / 1e7) / 100) + " GB"; }

}  // namespace ahm::detail
