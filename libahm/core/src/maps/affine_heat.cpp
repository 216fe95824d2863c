#include "maps/affine_heat.hpp"

#include <algorithm>
#include <cmath>

#include "ahm/util/parallel.hpp"

namespace ahm {

AffineHeat::AffineHeat(const TangentGraph& graph, const HeatOperators& operators, std::vector<Inflow> inflows,
                       unsigned threads)
    : graph_(graph),
      operators_(operators),
      inflows_(std::move(inflows)),
      n_(static_cast<std::size_t>(graph.size())),
      d_(static_cast<std::size_t>(graph.dimension())),
      frames_(graph.size(), graph.dimension(), graph.transport_kind()),
      threads_(threads) {}

FrameField AffineHeat::frames(std::size_t source) const {
  return FrameField(graph_.size(), graph_.dimension(), graph_.transport_kind(),
                    std::span(frame_solution_).subspan(source * frame_size(), frame_size()));
}

/// lambda = A^-1 b
void AffineHeat::diffuse_heat() {
  lambda_.assign(inflows_.size() * n_, 0.0);
  for (std::size_t s = 0; s < inflows_.size(); ++s)
    for (std::size_t k = 0; k < inflows_[s].vertices.size(); ++k)
      lambda_[s * n_ + static_cast<std::size_t>(inflows_[s].vertices[k])] += inflows_[s].heat[k];
  operators_.solve_scalar(lambda_, static_cast<Index>(inflows_.size()));
  least_heat_.clear();
  for (std::size_t s = 0; s < inflows_.size(); ++s) {
    const auto heat = lambda(s);
    least_heat_.push_back(least_share * *std::max_element(heat.begin(), heat.end()));
  }
}

/// U~ = B^-1 (b U_p) (Eq. 11)
void AffineHeat::diffuse_frames() {
  frame_solution_.assign(inflows_.size() * frame_size(), 0.0);
  const std::size_t width = frames_.width(), columns = static_cast<std::size_t>(frames_.columns());
  for (std::size_t s = 0; s < inflows_.size(); ++s)
    for (std::size_t k = 0; k < inflows_[s].vertices.size(); ++k) {
      const double* frame = inflows_[s].frames.data() + k * width;
      double* rhs = frame_solution_.data() + s * frame_size() + static_cast<std::size_t>(inflows_[s].vertices[k]) * d_;
      for (std::size_t a = 0; a < columns; ++a)
        for (std::size_t c = 0; c < d_; ++c) rhs[a * n_ * d_ + c] += frame[c * columns + a];
    }
  operators_.solve_vector(frame_solution_, static_cast<Index>(inflows_.size() * columns));
}

void AffineHeat::diffuse() {
  detail::run_both(
      threads_ > 1, [&] { diffuse_heat(); }, [&] { diffuse_frames(); });
}

/// rho_i = -tau sum_j w_ij e_ij lambda_j, columns of n vectors of d numbers. The translation from j to i is -e_ij: it
/// adds the displacement j -> i, so that the plane comes out exact.
std::vector<double> AffineHeat::translations() const {
  std::vector<double> rho(inflows_.size() * n_ * d_, 0.0);
  const double factor = -operators_.tau() * operators_.scaling();
  const double to_units = graph_.length_unit() / solution_unit(graph_);
  detail::for_each_index(n_, threads_, [&](std::size_t i) {
    const Star star = graph_.star(static_cast<Index>(i));
    for (std::size_t s = 0; s < inflows_.size(); ++s) {
      const double* lambda = lambda_.data() + s * n_;
      double* out = rho.data() + (s * n_ + i) * d_;
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const double amount = factor * star.weights[e] * lambda[star.neighbors[e]];
        for (std::size_t a = 0; a < d_; ++a) out[a] += amount * (to_units * star.logs[e * d_ + a]);
      }
    }
  });
  for (std::size_t s = 0; s < inflows_.size(); ++s)
    for (std::size_t k = 0; k < inflows_[s].vertices.size(); ++k)
      for (std::size_t a = 0; a < d_; ++a)
        rho[(s * n_ + static_cast<std::size_t>(inflows_[s].vertices[k])) * d_ + a] +=
            inflows_[s].translations[k * d_ + a];
  return rho;
}

std::vector<double> AffineHeat::adaptive() const {
  const std::vector<double> rho = translations();
  std::vector<double> x(rho.size());
  for (std::size_t s = 0; s < inflows_.size(); ++s) {
    double* columns = x.data() + s * n_ * d_;
    const FrameField U = frames(s);
    detail::for_each_index(n_, threads_, [&](std::size_t i) {
      U.to_source(static_cast<Index>(i), rho.data() + (s * n_ + i) * d_, columns + i, n_);
    });
    for (std::size_t k = 0; k < inflows_[s].vertices.size(); ++k)
      for (std::size_t a = 0; a < d_; ++a)
        columns[a * n_ + static_cast<std::size_t>(inflows_[s].vertices[k])] += inflows_[s].coordinates[k * d_ + a];
  }
  operators_.solve_scalar(x, static_cast<Index>(inflows_.size() * d_));
  return x;
}

std::vector<double> AffineHeat::localized() const {
  std::vector<double> Y = translations();
  for (std::size_t s = 0; s < inflows_.size(); ++s)
    for (std::size_t k = 0; k < inflows_[s].vertices.size(); ++k)
      for (std::size_t a = 0; a < d_; ++a)
        Y[(s * n_ + static_cast<std::size_t>(inflows_[s].vertices[k])) * d_ + a] += inflows_[s].vectors[k * d_ + a];
  operators_.solve_vector(Y, static_cast<Index>(inflows_.size()));
  return Y;
}

void AffineHeat::solution_at(Variant variant, std::span<const double> solution, Index vertex, double* out) const {
  const auto i = static_cast<std::size_t>(vertex);
  for (std::size_t a = 0; a < d_; ++a)
    out[a] = variant == Variant::adaptive ? solution[a * n_ + i] : solution[i * d_ + a];
}

void AffineHeat::coordinates_at(Variant variant, std::size_t source, std::span<const double> solution, Index vertex,
                                double* phi) const {
  if (variant == Variant::adaptive)
    solution_at(variant, solution, vertex, phi);
  else
    frames(source).to_source(vertex, solution.data() + static_cast<std::size_t>(vertex) * d_, phi);
  const double heat = lambda(source)[vertex], unit = solution_unit(graph_);
  for (std::size_t a = 0; a < d_; ++a) phi[a] = phi[a] / heat * unit;
}

std::vector<bool> AffineHeat::connected(std::size_t source) const {
  std::vector<bool> with_source(static_cast<std::size_t>(operators_.component_count()), false);
  const auto component = operators_.components();
  for (Index k : inflows_[source].vertices) with_source[component[k]] = true;
  std::vector<bool> result(n_);
  for (std::size_t i = 0; i < n_; ++i) result[i] = with_source[component[i]];
  return result;
}

}  // namespace ahm
