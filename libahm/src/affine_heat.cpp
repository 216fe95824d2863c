#include "affine_heat.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ahm/detail/parallel.hpp"
#include "ahm/error.hpp"

namespace ahm {

void check_source(const Source& source, const TangentGraph& graph) {
  const int d = graph.dimension();
  if (source.dimension() != 0 && source.dimension() != d)
    throw InvalidArgument("source has dimension " + std::to_string(source.dimension()) + ", the graph has " +
                          std::to_string(d));
  for (Index vertex : source.vertices())
    if (vertex < 0 || vertex >= graph.size())
      throw InvalidArgument("source vertex " + std::to_string(vertex) + " is outside [0, " +
                            std::to_string(graph.size()) + ")");
  const auto weights = source.weights();
  if (std::none_of(weights.begin(), weights.end(), [](double b) { return b > 0; }))
    throw InvalidArgument("source has no vertex of positive weight");
  if (graph.transport_kind() != TransportKind::rotation2) return;
  for (std::size_t k = 0; k * 4 < source.axes().size(); ++k)
    if (const auto U = source.axes().subspan(k * 4, 4); U[0] * U[3] - U[1] * U[2] < 0)
      throw InvalidArgument("source axes at vertex " + std::to_string(source.vertices()[k]) +
                            " are a reflection; this graph's frames are all oriented alike, so give a rotation");
}

AffineHeat::AffineHeat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Source> sources,
                       unsigned threads)
    : graph_(graph),
      operators_(operators),
      sources_(sources),
      n_(static_cast<std::size_t>(graph.size())),
      d_(static_cast<std::size_t>(graph.dimension())),
      threads_(threads),
      frames_(sources.size(), FrameField(graph.size(), graph.dimension(), graph.transport_kind())) {}

double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Index> vertices) {
  double mass = 1;
  for (Index vertex : vertices) mass = std::min(mass, operators.scaling() * graph.mass(vertex));
  return std::ldexp(heat_scale, std::max(-900, std::ilogb(mass)));
}

/// Calls visit(vertex, b_k scaled, z_k or empty, U_k or empty) for the samples with b_k > 0. The largest b_k becomes
/// `source_heat`; the factor cancels in every quotient by lambda.
template <class Visit>
void AffineHeat::for_each_sample(std::size_t source, const Visit& visit) const {
  const Source& s = sources_[source];
  const double largest = *std::max_element(s.weights().begin(), s.weights().end());
  const double scale = source_heat(graph_, operators_, s.vertices());
  for (std::size_t k = 0; k < s.vertices().size(); ++k) {
    if (!(s.weights()[k] > 0)) continue;
    const auto z = s.offsets().empty() ? s.offsets() : s.offsets().subspan(k * d_, d_);
    const auto U = s.axes().empty() ? s.axes() : s.axes().subspan(k * d_ * d_, d_ * d_);
    visit(s.vertices()[k], s.weights()[k] / largest * scale, z, U);
  }
}

/// lambda = A^-1 b
void AffineHeat::diffuse_heat() {
  lambda_.assign(sources_.size() * n_, 0.0);
  for (std::size_t s = 0; s < sources_.size(); ++s)
    for_each_sample(s, [&](Index k, double b, auto, auto) { lambda_[s * n_ + static_cast<std::size_t>(k)] += b; });
  operators_.solve_scalar(lambda_, static_cast<Index>(sources_.size()));
  least_heat_.clear();
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const auto heat = lambda(s);
    least_heat_.push_back(least_share * *std::max_element(heat.begin(), heat.end()));
  }
}

/// U~ = B^-1 (b U_p), normalized (Eq. 11, 12)
void AffineHeat::diffuse_frames() {
  const auto columns = static_cast<std::size_t>(frames_.front().columns());
  const std::size_t size = columns * n_ * d_;
  std::vector<double> U(sources_.size() * size, 0.0);
  for (std::size_t s = 0; s < sources_.size(); ++s)
    for_each_sample(s, [&](Index k, double b, auto, auto axes) {
      frames_[s].add_to_rhs(std::span(U).subspan(s * size, size), k, axes, b);
    });
  operators_.solve_vector(U, static_cast<Index>(sources_.size() * columns));
  for (std::size_t s = 0; s < sources_.size(); ++s)
    frames_[s].normalize(std::span(U).subspan(s * size, size), threads_);
}

void AffineHeat::diffuse() {
  detail::run_both(threads_ > 1, [&] { diffuse_heat(); }, [&] { diffuse_frames(); });
}

double AffineHeat::length_unit() const {
  return std::ldexp(graph_.length_unit(), std::ilogb(graph_.mean_edge_length()));
}

/// rho_i = -tau sum_j w_ij e_ij lambda_j, columns of n vectors of d numbers. The translation from j to i is -e_ij: it
/// adds the displacement j -> i, so that the plane comes out exact.
std::vector<double> AffineHeat::translations() const {
  std::vector<double> rho(sources_.size() * n_ * d_, 0.0);
  const double factor = -operators_.tau() * operators_.scaling();
  const double to_units = graph_.length_unit() / length_unit();
  detail::for_each_index(n_, threads_, [&](std::size_t i) {
    const Star star = graph_.star(static_cast<Index>(i));
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const double* lambda = lambda_.data() + s * n_;
      double* out = rho.data() + (s * n_ + i) * d_;
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const double amount = factor * star.weights[e] * lambda[star.neighbors[e]];
        for (std::size_t a = 0; a < d_; ++a) out[a] += amount * (to_units * star.logs[e * d_ + a]);
      }
    }
  });
  return rho;
}

std::vector<double> AffineHeat::adaptive() const {
  const std::vector<double> rho = translations();
  std::vector<double> x(rho.size());
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    double* columns = x.data() + s * n_ * d_;
    detail::for_each_index(n_, threads_, [&](std::size_t i) {
      frames_[s].to_source(static_cast<Index>(i), rho.data() + (s * n_ + i) * d_, columns + i, n_);
    });
    for_each_sample(s, [&](Index k, double b, auto z, auto) {
      for (std::size_t a = 0; a < z.size(); ++a)
        columns[a * n_ + static_cast<std::size_t>(k)] += b * z[a] / length_unit();
    });
  }
  operators_.solve_scalar(x, static_cast<Index>(sources_.size() * d_));
  return x;
}

std::vector<double> AffineHeat::localized() const {
  std::vector<double> Y = translations();
  for (std::size_t s = 0; s < sources_.size(); ++s)
    for_each_sample(s, [&](Index k, double b, auto z, auto U) {
      double* out = Y.data() + (s * n_ + static_cast<std::size_t>(k)) * d_;
      for (std::size_t c = 0; c < d_; ++c)
        for (std::size_t a = 0; a < z.size(); ++a) out[c] += b * U[c * d_ + a] * z[a] / length_unit();
    });
  operators_.solve_vector(Y, static_cast<Index>(sources_.size()));
  return Y;
}

std::vector<bool> AffineHeat::connected(std::size_t source) const {
  std::vector<bool> with_source(static_cast<std::size_t>(operators_.component_count()), false);
  const auto component = operators_.components();
  for_each_sample(source, [&](Index k, double, auto, auto) { with_source[component[k]] = true; });
  std::vector<bool> result(n_);
  for (std::size_t i = 0; i < n_; ++i) result[i] = with_source[component[i]];
  return result;
}

}  // namespace ahm
