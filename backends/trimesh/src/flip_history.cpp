#include "flip_history.hpp"

#include <algorithm>

namespace ahm::trimesh {
namespace {

/// b / p for 0 <= b, with 0 / 0 = 0.
double share(double b, double p) { return b > 0 ? b / p : 0.0; }

}  // namespace

void FlipHistory::add(Flip flip) {
  const auto number = static_cast<std::int32_t>(flips_.size());
  flip.next = {-1, -1};
  for (int b = 0; b < 2; ++b) {
    std::int32_t& last = last_[flip.face[b]];
    (last < 0 ? first_[flip.face[b]] : flips_[last / 2].next[last % 2]) = number;
    last = 2 * number + b;
  }
  flips_.push_back(flip);
}

FlipHistory::Point FlipHistory::locate(Index face, const std::array<double, 3>& weight) const {
  Point p{face, weight, {}, 0};
  for (std::int32_t at = first_[face]; at >= 0; ++p.depth) {
    const Flip& flip = flips_[at];
    const double alpha = 1 - flip.beta, delta = 1 - flip.gamma;
    double i, j, k = 0, m = 0;
    if (p.face == flip.face[0]) {
      i = p.weight[flip.side[0]];
      j = p.weight[(flip.side[0] + 1) % 3];
      k = p.weight[(flip.side[0] + 2) % 3];
    } else {
      if (flip.mirrored) {
        std::swap(p.weight[1], p.weight[2]);
        p.map = {conj(p.map.turn), !p.map.mirrored};
      }
      j = p.weight[flip.side[1]];
      i = p.weight[(flip.side[1] + 1) % 3];
      m = p.weight[(flip.side[1] + 2) % 3];
      p.map.turn = product(flip.turn, p.map.turn);
    }
    // In the triangle at i if i / alpha >= j / beta: write j as (gamma k + delta m - alpha i) / beta; else the same
    // with i.
    const bool at_i = i * flip.beta >= j * alpha;
    const double q = at_i ? share(j, flip.beta) : share(i, alpha);
    k += q * flip.gamma;
    m += q * delta;
    const int b = at_i ? 0 : 1;
    p.face = flip.face[b];
    p.weight[flip.side[b]] = at_i ? m : k;
    p.weight[(flip.side[b] + 1) % 3] = at_i ? k : m;
    p.weight[(flip.side[b] + 2) % 3] = std::max(0.0, at_i ? i - q * alpha : j - q * flip.beta);
    at = flip.next[b];
  }
  return p;
}

FlipHistory::Direction FlipHistory::locate(Half corner, Vec2 direction) const {
  Index face = corner / 3;
  int s = corner % 3;
  bool mirrored = false;
  for (std::int32_t at = first_[face]; at >= 0;) {
    const Flip& flip = flips_[at];
    int b, to;  // new face, and corner counted from its side m k or k m
    if (face == flip.face[0]) {
      const int q = (s - flip.side[0] + 3) % 3;  // corner i, j or k
      // At k: from k i counter-clockwise to the diagonal lies the face at i.
      b = q == 0 ? 0 : q == 1 ? 1 : cross(direction, flip.diagonal) >= 0 ? 1 : 0;
      to = q < 2 ? 2 : b == 0 ? 1 : 0;
    } else {
      if (flip.mirrored) {
        s = (3 - s) % 3;
        direction = conj(direction);
        mirrored = !mirrored;
      }
      direction = product(flip.turn, direction);
      const int q = (s - flip.side[1] + 3) % 3;  // corner j, i or m
      // At m: from the diagonal counter-clockwise to m i lies the face at i.
      b = q == 0 ? 1 : q == 1 ? 0 : cross(flip.diagonal, direction) >= 0 ? 0 : 1;
      to = q < 2 ? 2 : b == 0 ? 0 : 1;
    }
    face = flip.face[b];
    s = (flip.side[b] + to) % 3;
    at = flip.next[b];
  }
  return {3 * face + s, direction, mirrored};
}

}  // namespace ahm::trimesh
