/// \file
/// Conversion between sRGB values of images and linear light (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace ahm::detail {

/// Linear light of an sRGB value, both in [0, 1].
template <class Real>
Real light_of(Real tone) {
  return tone <= Real(0.04045) ? tone / Real(12.92) : std::pow((tone + Real(0.055)) / Real(1.055), Real(2.4));
}

/// sRGB value of linear light, both in [0, 1].
template <class Real>
Real tone_of(Real light) {
  return light <= Real(0.0031308) ? light * Real(12.92) : Real(1.055) * std::pow(light, Real(1 / 2.4)) - Real(0.055);
}

}  // namespace ahm::detail
