#include "maps/known_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

KnownValues::KnownValues(const TangentGraph& graph, const VariantSystem& system)
    : system_(system),
      layout_(graph.transport_layout()),
      d_(static_cast<std::size_t>(graph.dimension())),
      width_(layout_.width()),
      to_units_(graph.length_unit() / solution_unit(graph)),
      lambda_(static_cast<std::size_t>(graph.size())),
      value_(lambda_.size() * d_),
      square_(lambda_.size()),
      frame_(lambda_.size() * width_),
      exponents_(lambda_.size()) {}

void KnownValues::take(Index vertex, Index place, const AffineHeat& heat, std::size_t source, HeatExponents exponents) {
  lambda_[vertex] = heat.lambda(source)[place];
  heat.unknown_at(source, place, value_.data() + vertex * d_);
  square_[vertex] = heat.square_at(source, place);
  heat.frames(source).raw(place, frame_.data() + vertex * width_);
  exponents_[vertex] = exponents;
}

double KnownValues::level(Index vertex) const {
  return -std::log(lambda_[vertex]) - std::log(2.0) * exponents_[vertex].heat;
}

void KnownValues::axes(Index vertex, double* out) const {
  // One vertex is a field of its own, a column after the other.
  std::vector<double> columns(width_);
  const int d = layout_.dimension;
  for (int a = 0; a < layout_.columns(); ++a)
    for (int c = 0; c < d; ++c) columns[a * d + c] = frame(vertex)[layout_.place(c, a)];
  FrameField(1, layout_, columns).axes(0, out);
}

HeatExponents KnownValues::exponents_for(std::span<const Index> vertices) const {
  constexpr std::int32_t none = std::numeric_limits<std::int32_t>::min();
  HeatExponents largest{none, none};
  for (Index j : vertices) {
    if (lambda_[j] != 0) largest.heat = std::max(largest.heat, exponents_[j].heat + std::ilogb(lambda_[j]));
    for (double u : frame(j))
      if (u != 0) largest.frame = std::max(largest.frame, exponents_[j].frame + std::ilogb(u));
  }
  return {largest.heat - std::ilogb(heat_scale), largest.frame - std::ilogb(heat_scale)};
}

void KnownValues::add_to(Inflow& in, const Star& star, std::size_t edge, double conductance,
                         HeatExponents exponents) const {
  const Index j = star.neighbors[edge];
  const Transport R = star.transport(edge);
  const double heat = std::ldexp(conductance, exponents_[j].heat - exponents.heat);
  const double pair_factor[] = {-2 * heat * to_units_};
  const double turn = std::ldexp(conductance, exponents_[j].frame - exponents.frame);
  in.heat.back() += heat * lambda_[j];
  Scratch e(d_);
  double* translation = in.translations.data() + in.translations.size() - d_;
  for (std::size_t a = 0; a < d_; ++a) {
    e.data()[a] = to_units_ * star.log(edge)[a];
    translation[a] -= heat * lambda_[j] * e.data()[a];
  }
  in.squares.back() += heat * (square_[j] + dot(e.span(), e.span()) * lambda_[j]);
  system_.add_pairs(star.only(edge), pair_factor, value(j), in.pairs.data() + in.pairs.size() - d_ * d_);
  system_.add_known(heat, R, value(j), in.values.data() + in.values.size() - d_);
  R.add_product(turn, frame(j).data(), in.frames.data() + in.frames.size() - width_);
}

}  // namespace ahm
