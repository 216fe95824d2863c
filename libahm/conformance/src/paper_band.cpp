#include "ahm/conformance/paper_band.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace ahm::test {

PaperBand paper_band(Index around, Index across, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter(-0.24, 0.24);
  PaperBand band{around, across, {}, {}, {}, {}};
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j <= across; ++j) {
      const double b = j > 0 && j < across ? jitter(random) : 0;
      band.plane.push_back({(i + jitter(random)) / around, 0.2 * (j + b) / across});
    }
  auto vertex = [&](Index i, Index j) { return i < around ? i * (across + 1) + j : across - j; };
  auto position = [&](Index i, Index j) {
    const auto& p = band.plane[vertex(i, j)];
    return i < around ? p : std::array{p[0] + 1, 0.2 - p[1]};
  };
  auto add = [&](std::array<std::array<Index, 2>, 3> corners) {
    // Faces have random orientations.
    if (random() % 2) std::swap(corners[1], corners[2]);
    band.faces.emplace_back();
    band.lengths.emplace_back();
    for (int s = 0; s < 3; ++s) {
      band.faces.back()[s] = vertex(corners[s][0], corners[s][1]);
      band.corners.push_back(position(corners[s][0], corners[s][1]));
    }
    for (int s = 0; s < 3; ++s) {
      const auto &p = band.corners[band.corners.size() - 3 + s],
                 &q = band.corners[band.corners.size() - 3 + (s + 1) % 3];
      band.lengths.back()[s] = std::hypot(p[0] - q[0], p[1] - q[1]);
    }
  };
  for (Index i = 0; i < around; ++i)
    for (Index j = 0; j < across; ++j) {
      if (random() % 2) {
        add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
        add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
      } else {
        add({{{i, j}, {i + 1, j}, {i, j + 1}}});
        add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
    }
  return band;
}

double PaperBand::distance(const Vec2& p, const Vec2& q) const {
  double least = std::hypot(p[0] - q[0], p[1] - q[1]);
  for (double turn : {-1.0, 1.0}) least = std::min(least, std::hypot(p[0] - q[0] + turn, p[1] - (0.2 - q[1])));
  return least;
}

}  // namespace ahm::test
