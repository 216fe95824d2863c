#include "intrinsic_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm/util/parallel.hpp"
#include "ahm/util/unset_vector.hpp"
#include "triangle_mesh_surface.hpp"

namespace ahm::trimesh {
namespace {

/// b / p for b >= 0, with 0 / 0 = 0.
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
    // The point is in the triangle at i if i / alpha >= j / beta. Then j is replaced by
    // (gamma k + delta m - alpha i) / beta. Otherwise i is replaced likewise.
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
    int b, to;  // new face; its corner, counted from the side on the diagonal
    if (face == flip.face[0]) {
      const int q = (s - flip.side[0] + 3) % 3;  // corner i, j or k
      // At k the face at i extends from k i counter-clockwise to the diagonal.
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
      // At m the face at i extends from the diagonal counter-clockwise to m i.
      b = q == 0 ? 1 : q == 1 ? 0 : cross(flip.diagonal, direction) >= 0 ? 0 : 1;
      to = q < 2 ? 2 : b == 0 ? 0 : 1;
    }
    face = flip.face[b];
    s = (flip.side[b] + to) % 3;
    at = flip.next[b];
  }
  return {3 * face + s, direction, mirrored};
}

namespace {

/// Margin of mollified faces in the triangle inequality, in mean edge lengths.
constexpr double mollified_margin = 1e-8;

/// Sides shorter than this fraction of the longest side of their face have no direction.
constexpr double min_side = 1e-15;

/// Sines below this are rounding errors. Its inverse bounds cotangents.
constexpr double min_sine = 1e-16;

}  // namespace

IntrinsicTriangulation::IntrinsicTriangulation(const TriangleMesh& mesh, bool mollify_now, unsigned threads)
    : tail_(mesh.tails().begin(), mesh.tails().end()),
      twin_(mesh.twins().begin(), mesh.twins().end()),
      mirrored_(mesh.mirrored().begin(), mesh.mirrored().end()),
      side_(mesh.tails().size()),
      dropped_(mesh.topology().dropped().begin(), mesh.topology().dropped().end()),
      history_(mesh.tails().size() / 3) {
  detail::for_each_index(static_cast<std::size_t>(mesh.face_count()), threads, [&](std::size_t f) {
    if (is_dropped(static_cast<Index>(f))) return;
    const auto layout = mesh.layout(static_cast<Index>(f));
    for (int s = 0; s < 3; ++s) side_[3 * f + s] = layout[s];
  });
  if (mollify_now) mollify();
}

void IntrinsicTriangulation::mollify() {
  std::vector<double> length(side_.size());
  double mean = 0;
  for (std::size_t h = 0; h < side_.size(); ++h) {
    // The length must be the same in both faces of an edge, to the last bit.
    const Half t = twin_[h];
    length[h] = norm(side_[t >= 0 && t < static_cast<Half>(h) ? t : static_cast<Half>(h)]);
    mean += length[h] / static_cast<double>(side_.size());
  }
  const double margin = mollified_margin * (mean > 0 ? mean : 1.0);
  double epsilon = 0;
  for (std::size_t f = 0; f < length.size(); f += 3) {
    if (is_dropped(static_cast<Index>(f / 3))) continue;
    const double sum = length[f] + length[f + 1] + length[f + 2];
    for (int s = 0; s < 3; ++s) epsilon = std::max(epsilon, margin - (sum - 2.0 * length[f + s]));
  }
  for (std::size_t f = 0; f < length.size(); f += 3) {
    if (is_dropped(static_cast<Index>(f / 3))) continue;
    const FaceLayout layout = layout_of_lengths(length[f] + epsilon, length[f + 1] + epsilon, length[f + 2] + epsilon);
    std::copy(layout.begin(), layout.end(), side_.begin() + static_cast<std::ptrdiff_t>(f));
  }
  mollification_ = epsilon;
}

double IntrinsicTriangulation::area(Index face) const {
  const Vec2* s = sides(face);
  return 0.5 * cross(s[0], s[1]);
}

double IntrinsicTriangulation::cotangent(Half h) const {
  const Vec2 a = side_[previous(h)], b = -side_[next(h)];
  return dot(a, b) / std::max(cross(a, b), min_sine * norm(a) * norm(b));
}

double IntrinsicTriangulation::angle(Half h) const {
  return std::max(0.0, angle_between(side_[h], -side_[previous(h)]));
}

/// Whether the apexes of two flat faces at an edge coincide, so that a flip would make a diagonal without length.
bool IntrinsicTriangulation::opposite_coincide(Half h) const {
  const Half t = twin_[h];
  const double length = norm(side_[h]), along_h = -dot(side_[h], side_[previous(h)]) / length,
               along_t = -dot(side_[t], side_[previous(t)]) / norm(side_[t]);
  const bool mirrored = !mirrored_.empty() && mirrored_[h];
  return std::abs(along_h - (mirrored ? along_t : length - along_t)) <= min_side * length;
}

/// Whether the angles opposite the edge sum to at most pi, up to rounding, or a flip is impossible.
bool IntrinsicTriangulation::is_delaunay(Half h) const {
  const Half t = twin_[h];
  // A boundary edge, or two sides of one face, which is folded onto itself.
  if (t < 0 || h / 3 == t / 3) return true;
  auto opposite = [this](Half side) {
    const Vec2 a = side_[previous(side)], b = -side_[next(side)];
    const double scale = 1 / std::sqrt(dot(a, a) * dot(b, b));
    return Vec2{dot(a, b) * scale, std::max(0.0, cross(a, b)) * scale};  // cosine, sine
  };
  const Vec2 p = opposite(h), q = opposite(t);
  if (p[0] < 0 && q[0] < 0) return std::max(p[1], q[1]) < min_sine && opposite_coincide(h);
  return p[0] * q[1] + p[1] * q[0] >= -1e-15 - 1e-10 * p[1] * q[1];
}

bool IntrinsicTriangulation::flip_to_delaunay(unsigned threads, const Progress& progress) {
  detail::UnsetVector<char> flips(twin_.size());
  detail::for_each_index(flips.size(), threads, [&](std::size_t i) {
    const auto h = static_cast<Half>(i);
    flips[i] = h < twin_[h] && !is_delaunay(h);
  });
  std::vector<Half> stack;
  for (Half h = static_cast<Half>(twin_.size()) - 1; h >= 0; --h)
    if (flips[h]) stack.push_back(h);
  const bool done = detail::flip_to_delaunay(
      std::move(stack), 64 * tail_.size() + 1024, [&](Half h) { return twin_[h]; },
      [&](Half h) { return is_delaunay(h); },
      [&](Half h) {
        flip(h);
        if ((history_.size() & 0xffff) == 0) progress.step("flips", 0.5);
      });
  history_.finish();
  return done;
}

/// Turns over the face of h: corners (a, b, c) become (a, c, b), side s becomes side 2 - s, and the layout is mirrored.
/// @return the new number of h
Half IntrinsicTriangulation::turn_over(Half h) {
  const Half f = 3 * (h / 3);
  auto moved = [f](Half side) { return f + 2 - (side - f); };
  std::swap(tail_[f + 1], tail_[f + 2]);
  const Vec2 old_side[3] = {side_[f], side_[f + 1], side_[f + 2]};
  const Half old_twin[3] = {twin_[f], twin_[f + 1], twin_[f + 2]};
  const std::uint8_t old_mirrored[3] = {mirrored_[f], mirrored_[f + 1], mirrored_[f + 2]};
  for (Half s = 0; s < 3; ++s) {
    const Half to = f + 2 - s, t = old_twin[s];
    side_[to] = conj(-old_side[s]);
    const bool inside = t >= f && t < f + 3;
    twin_[to] = inside ? moved(t) : t;
    mirrored_[to] = t < 0 || inside ? old_mirrored[s] : !old_mirrored[s];
    if (t < 0 || inside) continue;
    twin_[t] = to;
    mirrored_[t] = mirrored_[to];
  }
  return moved(h);
}

/// Lays out the faces (i, j, k) of h and (j, i, m) of t together, in the layout of the first one.
IntrinsicTriangulation::Quadrilateral IntrinsicTriangulation::unfold(Half h, Half t) const {
  Quadrilateral q;
  const Vec2 ij = side_[h];
  q.turn = normalized(product(ij, conj(-side_[t])));
  q.jk = side_[next(h)];
  q.ki = side_[previous(h)];
  q.im = product(q.turn, side_[next(t)]);
  q.mj = product(q.turn, side_[previous(t)]);
  // The diagonal is the sum of the shorter pair of sides.
  const bool by_i = dot(q.im, q.im) + dot(q.ki, q.ki) < dot(q.mj, q.mj) + dot(q.jk, q.jk);
  q.mk = by_i ? -(q.im + q.ki) : q.mj + q.jk;
  // The diagonals cross at gamma k + delta m = alpha i + beta j.
  const double height_k = std::max(0.0, cross(ij, -q.ki)), height_m = std::max(0.0, cross(q.im, ij));
  q.gamma = height_k + height_m > 0 ? height_m / (height_k + height_m) : 0.5;
  const Vec2 crossing = (1 - q.gamma) * q.im - q.gamma * q.ki;
  q.beta = std::clamp(dot(crossing, ij) / dot(ij, ij), 0.0, 1.0);
  return q;
}

/// Replaces the faces (i, j, k) and (j, i, m) on both sides of edge (i, j) by (m, k, i) and (k, m, j).
void IntrinsicTriangulation::flip(Half h) {
  const bool mirrored = !mirrored_.empty() && mirrored_[h];
  const Half t = mirrored ? turn_over(twin_[h]) : twin_[h];
  const Quadrilateral q = unfold(h, t);
  history_.add({{h / 3, t / 3},
                {},
                {static_cast<std::uint8_t>(h % 3), static_cast<std::uint8_t>(t % 3)},
                mirrored,
                q.beta,
                q.gamma,
                q.turn,
                q.mk});
  const Half jk = next(h), ki = previous(h), im = next(t), mj = previous(t);
  const Index i = tail_[h], j = tail_[t], k = tail_[ki], m = tail_[mj];
  detail::relink<Half>({ki, im, mj, jk}, {jk, ki, im, mj}, twin_, mirrored_);
  auto set = [this](Half half, Index tail, Vec2 side) {
    tail_[half] = tail;
    side_[half] = side;
  };
  set(h, m, q.mk);
  set(jk, k, q.ki);
  set(ki, i, q.im);
  set(t, k, -q.mk);
  set(im, m, q.mj);
  set(mj, j, q.jk);
  if (!mirrored_.empty()) mirrored_[h] = mirrored_[t] = 0;
}

std::vector<Index> IntrinsicTriangulation::thin_faces() const {
  std::vector<Index> faces;
  for (Index f = 0; f < static_cast<Index>(tail_.size() / 3); ++f)
    if (!is_dropped(f) && !(relative_height(sides(f)) >= min_relative_height)) faces.push_back(f);
  return faces;
}

bool IntrinsicTriangulation::has_angles() const {
  for (Index f = 0; f < static_cast<Index>(tail_.size() / 3); ++f) {
    if (is_dropped(f)) continue;
    const double l[3] = {norm(side_[3 * f]), norm(side_[3 * f + 1]), norm(side_[3 * f + 2])};
    const auto [least, largest] = std::minmax({l[0], l[1], l[2]});
    if (!(least > min_side * largest)) return false;
  }
  return true;
}

std::size_t IntrinsicTriangulation::bytes() const {
  return tail_.size() * (sizeof(Index) + sizeof(Half) + sizeof(Vec2)) + history_.bytes();
}

}  // namespace ahm::trimesh
