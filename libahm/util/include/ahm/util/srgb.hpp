/// \file
/// The tones of pictures and the light that they stand for (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace ahm::detail {

/// The linear light of an sRGB tone; both in [0, 1].
template <class Real>
Real light_of(Real tone) {
  return tone <= Real(0.04045) ? tone / Real(12.92) : std::pow((tone + Real(0.055)) / Real(1.055), Real(2.4));
}

}  // namespace ahm::detail
