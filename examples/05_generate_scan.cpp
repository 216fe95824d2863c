// Prints a scan of a bumpy sphere with noise, holes and uneven density, as x y z lines: 05_generate_scan > scan.xyz
#include <cmath>
#include <cstdio>
#include <random>

int main() {
  std::mt19937_64 random(2026);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int kept = 0; kept < 30000;) {
    double p[3] = {normal(random), normal(random), normal(random)};
    const double r = std::hypot(p[0], p[1], p[2]);
    for (double& x : p) x /= r;
    // The scanner is above: fewer points below, none in two round shadows.
    if (uniform(random) > 0.15 + 0.85 * (p[2] + 1) / 2) continue;
    if (p[0] > 0.93 || p[1] < -0.96) continue;
    const double bump = 1 + 0.08 * std::sin(5 * p[0]) * std::cos(4 * p[1]) + 0.002 * normal(random);
    std::printf("%.6f %.6f %.6f\n", bump * p[0], bump * p[1], bump * p[2]);
    ++kept;
  }
}
