/// \file
/// A small mesh as a file.
#pragma once

#include <cmath>
#include <sstream>
#include <string>

namespace ahm::test {

/// A sheared grid of m x m vertices in the unit square, its triangles long and thin, as OBJ.
inline std::string sheet(int m, double z = 0) {
  std::ostringstream text;
  text.precision(17);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      text << "v " << (i + 0.3 * std::sin(5.0 * j)) / (m - 1) << ' ' << 0.1 * j / (m - 1) << ' ' << z << '\n';
  for (int j = 0; j + 1 < m; ++j)
    for (int i = 0; i + 1 < m; ++i) {
      const int a = j * m + i + 1;
      text << "f " << a << ' ' << a + 1 << ' ' << a + m + 1 << "\nf " << a << ' ' << a + m + 1 << ' ' << a + m << '\n';
    }
  return text.str();
}

}  // namespace ahm::test
