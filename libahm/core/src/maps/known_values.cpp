#include "maps/known_values.hpp"

#include <cmath>
#include <limits>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

constexpr std::int32_t no_exponent = std::numeric_limits<std::int32_t>::min() / 2;

KnownValues::KnownValues(const TangentGraph& graph, const VariantSystem& system, bool with_frames)
    : system_(system),
      layout_(graph.transport_layout()),
      d_(static_cast<std::size_t>(graph.dimension())),
      width_(with_frames ? layout_.width() : 0),
      to_units_(graph.length_unit() / solution_unit(graph)),
      rows_(row_width()),
      exponents_(1) {}

void KnownValues::take_heat(Index number, double lambda, std::int32_t exponent) {
  rows_.grow_to(number + 1);
  exponents_.grow_to(number + 1);
  *rows_[number] = lambda;
  exponents_[number]->heat = exponent;
}

void KnownValues::take_values(Index number, Index place, const AffineHeat& heat, std::size_t source,
                              std::int32_t frame_exponent) {
  double* row = rows_[number];
  row[1] = heat.has_squares() ? heat.square_at(source, place) : 0;
  heat.unknown_at(source, place, row + 3);
  if (heat.has_lengths()) {
    row[2] = heat.length_at(source, place);
    heat.radial_at(source, place, row + 3 + d_);
  } else {
    row[2] = 0;
    std::fill_n(row + 3 + d_, d_, 0.0);
  }
  if (width_ > 0) heat.frames(source).raw(place, row + 3 + 2 * d_);
  exponents_[number]->frame = frame_exponent;
}

void KnownValues::set(Index number, std::span<const double> row, HeatExponents exponents) {
  rows_.grow_to(number + 1);
  exponents_.grow_to(number + 1);
  std::copy(row.begin(), row.end(), rows_[number]);
  *exponents_[number] = exponents;
}

double KnownValues::level(Index number) const {
  return -std::log(heat(number)) - std::log(2.0) * exponents_[number]->heat;
}

void KnownValues::axes(Index number, double* out) const {
  // A field of a single vertex, column by column.
  Scratch columns(width_);
  const int d = layout_.dimension;
  for (int a = 0; a < layout_.columns(); ++a)
    for (int c = 0; c < d; ++c) columns.data()[a * d + c] = frame(number)[layout_.place(c, a)];
  FrameField(1, layout_, columns.span()).axes(0, out);
}

std::int32_t KnownValues::heat_exponent_for(std::span<const Index> numbers) const {
  std::int32_t largest = no_exponent;
  for (Index j : numbers)
    if (heat(j) != 0) largest = std::max(largest, exponents_[j]->heat + std::ilogb(heat(j)));
  return largest - std::ilogb(heat_scale);
}

std::int32_t KnownValues::frame_exponent_for(std::span<const Index> numbers) const {
  std::int32_t largest = no_exponent;
  for (Index j : numbers)
    for (double u : frame(j))
      if (u != 0) largest = std::max(largest, exponents_[j]->frame + std::ilogb(u));
  return largest - std::ilogb(heat_scale);
}

double KnownValues::heat_along(Index number, double conductance, std::int32_t exponent) const {
  return std::ldexp(conductance, exponents_[number]->heat - exponent) * heat(number);
}

void KnownValues::add_to(RightHandSide& in, const Star& star, std::size_t edge, Index number, double conductance,
                         HeatExponents exponents) const {
  const Transport R = star.transport(edge);
  const double heat = std::ldexp(conductance, exponents_[number]->heat - exponents.heat);
  const double pair_factor[] = {-2 * heat * to_units_};
  const double lambda = this->heat(number);
  Scratch e(d_), seen(d_);
  double* translation = in.translations.data() + in.translations.size() - d_;
  for (std::size_t a = 0; a < d_; ++a) {
    e.data()[a] = to_units_ * star.log(edge)[a];
    translation[a] -= heat * lambda * e.data()[a];
  }
  in.squares.back() += heat * (square(number) + dot(e.span(), e.span()) * lambda);
  R.apply(radial(number).data(), seen.data());
  in.lengths.back() +=
      heat * (squared_length(number) + dot(e.span(), e.span()) * lambda - 2 * dot(e.span(), seen.span()));
  system_.add_pairs(star.only(edge), pair_factor, value(number), in.pairs.data() + in.pairs.size() - d_ * d_);
  system_.add_known(heat, R, value(number), in.values.data() + in.values.size() - d_);
  if (width_ == 0) return;
  const double turn = std::ldexp(conductance, exponents_[number]->frame - exponents.frame);
  R.add_product(turn, frame(number).data(), in.frames.data() + in.frames.size() - width_);
}

}  // namespace ahm
