#include "maps/frame_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/scratch.hpp"

namespace ahm {
FrameField::FrameField(Index n, TransportLayout layout, std::span<const double> solution)
    : n_(static_cast<std::size_t>(n)), layout_(layout), solution_(solution) {}

void FrameField::raw(Index vertex, double* out) const {
  const int d = layout_.dimension;
  for (int a = 0; a < layout_.columns(); ++a)
    for (int c = 0; c < d; ++c) out[layout_.place(c, a)] = solution_[(a * n_ + vertex) * d + c];
}

double FrameField::heat(Index vertex) const {
  const int d = layout_.dimension;
  double largest = 0;
  for (int a = 0; a < layout_.columns(); ++a)
    for (int c = 0; c < d; ++c) largest = std::max(largest, std::abs(solution_[(a * n_ + vertex) * d + c]));
  return largest;
}

void FrameField::frame(Index vertex, double* out) const {
  if (layout_.kind == TransportKind::rotation2) return rotation(vertex, out);
  raw(vertex, out);
  const double largest = heat(vertex);
  if (!(largest >= std::numeric_limits<double>::min())) return layout_.set_identity(out);
  for (std::size_t k = 0; k < layout_.width(); ++k) out[k] /= largest;
  layout_.make_orthogonal(out);
}

/// `frame` for complex numbers, without the general case: most graphs use it at every vertex.
void FrameField::rotation(Index vertex, double* out) const {
  const double re = solution_[2 * static_cast<std::size_t>(vertex)],
               im = solution_[2 * static_cast<std::size_t>(vertex) + 1];
  const double largest = std::max(std::abs(re), std::abs(im));
  if (!(largest >= std::numeric_limits<double>::min())) return layout_.set_identity(out);
  const double c = re / largest, s = im / largest, r = std::sqrt(c * c + s * s);
  out[0] = c / r;
  out[1] = s / r;
}

void FrameField::to_source(Index vertex, const double* in, double* out, std::size_t stride) const {
  Scratch U(layout_.width());
  frame(vertex, U.data());
  Transport(layout_, U.data()).apply_inverse(in, out, stride);
}

void FrameField::axes(Index vertex, double* out) const {
  Scratch U(layout_.width());
  frame(vertex, U.data());
  Transport(layout_, U.data()).matrix(out);
}

}  // namespace ahm
