#include "maps/affine_heat.hpp"

#include <cmath>
#include <string>

#include "ahm/error.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/scratch.hpp"
#include "ahm/util/small_math.hpp"

namespace ahm {

void check_source(const Source& source, const TangentGraph& graph) {
  const int d = graph.dimension();
  if (source.dimension().value_or(d) != d)
    throw InvalidArgument("source has dimension " + std::to_string(*source.dimension()) + ", the graph has " +
                          std::to_string(d));
  for (Vertex vertex : source.vertices())
    if (vertex.index < 0 || vertex.index >= graph.size())
      throw InvalidArgument("source vertex " + std::to_string(vertex.index) + " is outside [0, " +
                            std::to_string(graph.size()) + ")");
  const auto weights = source.weights();
  if (std::none_of(weights.begin(), weights.end(), [](double b) { return b > 0; }))
    throw InvalidArgument("source has no vertex of positive weight");
  if (graph.transport_layout().may_reflect()) return;
  for (std::size_t k = 0; k * 4 < source.axes().size(); ++k)
    if (const auto U = source.axes().subspan(k * 4, 4); U[0] * U[3] - U[1] * U[2] < 0)
      throw InvalidArgument("source axes at vertex " + std::to_string(source.vertices()[k].index) +
                            " are a reflection; the frames of this graph have one orientation, so use a rotation");
}

double solution_unit(const TangentGraph& graph) {
  return std::ldexp(graph.length_unit(), std::ilogb(graph.mean_edge_length()));
}

double source_heat(const TangentGraph& graph, const HeatOperators& operators, std::span<const Vertex> vertices) {
  double mass = 1;
  for (Vertex vertex : vertices) mass = std::min(mass, operators.scaling() * graph.mass(vertex.index));
  return std::ldexp(heat_scale, std::max(-900, std::ilogb(mass)));
}

RightHandSide right_hand_side_of(const Source& source, const TangentGraph& graph, const HeatOperators& operators,
                                 Variant variant, const std::function<bool(Index)>& keep) {
  const auto d = static_cast<std::size_t>(graph.dimension());
  const TransportLayout layout = graph.transport_layout();
  const VariantSystem& system = system_of(variant);
  const double largest = *std::max_element(source.weights().begin(), source.weights().end());
  const double scale = source_heat(graph, operators, source.vertices()), unit = solution_unit(graph);
  std::vector<double> identity(d * d, 0.0), z(d, 0.0);
  for (std::size_t a = 0; a < d; ++a) identity[a * (d + 1)] = 1.0;
  RightHandSide in;
  for (std::size_t k = 0; k < source.vertices().size(); ++k) {
    if (!(source.weights()[k] > 0) || (keep && !keep(source.vertices()[k].index))) continue;
    const double b = source.weights()[k] / largest * scale;
    for (std::size_t a = 0; a < d && !source.offsets().empty(); ++a) z[a] = source.offsets()[k * d + a] / unit;
    const auto U = source.axes().empty() ? std::span<const double>(identity) : source.axes().subspan(k * d * d, d * d);
    in.vertices.push_back(source.vertices()[k].index);
    in.heat.push_back(b);
    const std::size_t first = in.frames.size();
    in.frames.resize(first + layout.width());
    layout.store(U, in.frames.data() + first);
    for (std::size_t c = first; c < in.frames.size(); ++c) in.frames[c] *= b;
    in.values.resize(in.values.size() + d);
    system.add_sample(b, U, z, in.values.data() + in.values.size() - d);
    in.squares.push_back(b * dot(z, z));
  }
  in.translations.assign(in.vertices.size() * d, 0.0);
  return in;
}

std::vector<RightHandSide> right_hand_side_of(std::span<const Source> sources, const TangentGraph& graph,
                                              const HeatOperators& operators, Variant variant) {
  std::vector<RightHandSide> result;
  for (const Source& source : sources) result.push_back(right_hand_side_of(source, graph, operators, variant));
  return result;
}

SourceComponents::SourceComponents(const Source& source, std::span<const Index> component_of_vertex)
    : component_(component_of_vertex), has_source_(component_of_vertex.size(), 0) {
  for (std::size_t k = 0; k < source.vertices().size(); ++k)
    if (source.weights()[k] > 0) has_source_[component_[source.vertices()[k].index]] = 1;
}

AffineHeat::AffineHeat(const TangentGraph& graph, const HeatOperators& operators, Variant variant,
                       std::vector<RightHandSide> right_hand_sides, unsigned threads)
    : graph_(graph),
      operators_(operators),
      system_(system_of(variant)),
      rhs_(std::move(right_hand_sides)),
      n_(static_cast<std::size_t>(graph.size())),
      d_(static_cast<std::size_t>(graph.dimension())),
      layout_(graph.transport_layout()),
      place_(system_.layout(n_, d_)),
      threads_(threads) {}

FrameField AffineHeat::frames(std::size_t source) const {
  const std::span<const double> all = frame_solution_;
  return FrameField(graph_.size(), layout_, all.empty() ? all : all.subspan(source * frame_size(), frame_size()));
}

/// lambda = A^-1 b
void AffineHeat::diffuse_heat() {
  lambda_.assign(rhs_.size() * n_, 0.0);
  for (std::size_t s = 0; s < rhs_.size(); ++s)
    for (std::size_t k = 0; k < rhs_[s].vertices.size(); ++k)
      lambda_[s * n_ + static_cast<std::size_t>(rhs_[s].vertices[k])] += rhs_[s].heat[k];
  operators_.solve_scalar(lambda_, static_cast<Index>(rhs_.size()), threads_);
  min_heat_.clear();
  for (std::size_t s = 0; s < rhs_.size(); ++s) {
    const auto heat = lambda(s);
    min_heat_.push_back(heat.empty() ? 0 : min_heat_share * *std::max_element(heat.begin(), heat.end()));
  }
}

/// U~ = B^-1 (b U_p) (Eq. 11)
void AffineHeat::diffuse_frames() {
  frame_solution_.assign(rhs_.size() * frame_size(), 0.0);
  const std::size_t width = layout_.width();
  const int columns = layout_.columns();
  for (std::size_t s = 0; s < rhs_.size(); ++s)
    for (std::size_t k = 0; k < rhs_[s].vertices.size(); ++k) {
      const double* frame = rhs_[s].frames.data() + k * width;
      double* rhs = frame_solution_.data() + s * frame_size() + static_cast<std::size_t>(rhs_[s].vertices[k]) * d_;
      for (int a = 0; a < columns; ++a)
        for (std::size_t c = 0; c < d_; ++c) rhs[a * n_ * d_ + c] += frame[layout_.place(static_cast<int>(c), a)];
    }
  operators_.solve_vector(frame_solution_, static_cast<Index>(rhs_.size()) * columns, threads_);
}

void AffineHeat::diffuse() {
  detail::run_both(
      threads_, [&] { diffuse_heat(); }, [&] { diffuse_frames(); });
}

/// rho_i = -tau sum_j w_ij e_ij lambda_j, columns of n vectors of d numbers. The translation from j to i adds the displacement from j to i,
/// which is -e_ij in the frame of i. With this sign the map of a plane is exact.
std::vector<double> AffineHeat::translations() const {
  std::vector<double> rho(rhs_.size() * n_ * d_, 0.0);
  const double to_units = graph_.length_unit() / solution_unit(graph_);
  detail::for_each_index(n_, threads_, [&](std::size_t i) {
    const Star star = graph_.star(static_cast<Index>(i));
    const double factor = -operators_.tau()[i] * operators_.scaling();
    for (std::size_t s = 0; s < rhs_.size(); ++s) {
      const double* lambda = lambda_.data() + s * n_;
      double* out = rho.data() + (s * n_ + i) * d_;
      if (d_ == 2) {
        double along = 0, across = 0;
        for (std::size_t e = 0; e < star.degree(); ++e) {
          const double amount = factor * star.weights[e] * lambda[star.neighbors[e]];
          along += amount * (to_units * star.logs[2 * e]);
          across += amount * (to_units * star.logs[2 * e + 1]);
        }
        out[0] = along, out[1] = across;
        continue;
      }
      for (std::size_t e = 0; e < star.degree(); ++e) {
        const double amount = factor * star.weights[e] * lambda[star.neighbors[e]];
        for (std::size_t a = 0; a < d_; ++a) out[a] += amount * (to_units * star.logs[e * d_ + a]);
      }
    }
  });
  for (std::size_t s = 0; s < rhs_.size(); ++s)
    for (std::size_t k = 0; k < rhs_[s].vertices.size(); ++k)
      for (std::size_t a = 0; a < d_; ++a)
        rho[(s * n_ + static_cast<std::size_t>(rhs_[s].vertices[k])) * d_ + a] += rhs_[s].translations[k * d_ + a];
  return rho;
}

void AffineHeat::solve() {
  const std::vector<double> rho = translations();
  unknown_.assign(rho.size(), 0.0);
  for (std::size_t s = 0; s < rhs_.size(); ++s) {
    double* right_side = unknown_.data() + s * n_ * d_;
    const FrameField U = frames(s);
    detail::for_each_index(n_, threads_, [&](std::size_t i) {
      system_.set_right_side(U, static_cast<Index>(i), std::span(rho).subspan((s * n_ + i) * d_, d_), right_side, n_);
    });
    for (std::size_t k = 0; k < rhs_[s].vertices.size(); ++k)
      for (std::size_t a = 0; a < d_; ++a)
        right_side[place_.place(static_cast<std::size_t>(rhs_[s].vertices[k]), a)] += rhs_[s].values[k * d_ + a];
  }
  system_.solve(operators_, unknown_, rhs_.size(), threads_);
}

/// q = A^-1 (s + b |z|^2), s_i = -tau sum_j w_ij (2 <e_ij, z_j> - |e_ij|^2 lambda_j)
void AffineHeat::solve_squares() {
  const double to_units = graph_.length_unit() / solution_unit(graph_);
  squares_.resize(rhs_.size() * n_);
  detail::parallel_chunks(static_cast<Offset>(n_), 1 << 14, threads_, [&](Offset begin, Offset end) {
    std::vector<double> amounts, factors, values;
    Scratch pairs(d_ * d_);
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const Star star = graph_.star(static_cast<Index>(i));
      const double coefficient = -operators_.tau()[i] * operators_.scaling() * to_units;
      amounts.resize(star.degree());
      factors.resize(star.degree());
      values.resize(star.degree() * d_);
      for (std::size_t k = 0; k < star.degree(); ++k) {
        factors[k] = 2 * coefficient * star.weights[k];
        amounts[k] = coefficient * star.weights[k] * to_units * dot(star.log(k), star.log(k));
      }
      for (std::size_t s = 0; s < rhs_.size(); ++s) {
        const double *lambda = lambda_.data() + s * n_, *x = unknown_.data() + s * n_ * d_;
        double squares = 0;
        for (std::size_t k = 0; k < star.degree(); ++k) {
          const auto j = static_cast<std::size_t>(star.neighbors[k]);
          squares += amounts[k] * lambda[j];
          for (std::size_t a = 0; a < d_; ++a) values[k * d_ + a] = x[place_.place(j, a)];
        }
        std::fill(pairs.span().begin(), pairs.span().end(), 0.0);
        system_.add_pairs(star, factors, values, pairs.data());
        squares_[s * n_ + i] = system_.sum_of_pairs(frames(s), static_cast<Index>(i), pairs.span()) - squares;
      }
    }
  });
  for (std::size_t s = 0; s < rhs_.size(); ++s) {
    const RightHandSide& in = rhs_[s];
    for (std::size_t k = 0; k < in.vertices.size(); ++k) {
      double& entry = squares_[s * n_ + static_cast<std::size_t>(in.vertices[k])];
      entry += in.squares[k];
      if (!in.pairs.empty())
        entry += system_.sum_of_pairs(frames(s), in.vertices[k], std::span(in.pairs).subspan(k * d_ * d_, d_ * d_));
    }
  }
  operators_.solve_scalar(squares_, static_cast<Index>(rhs_.size()), threads_);
}

/// p = A^-1 (s + b |z|^2), with s as for q but z_j replaced by `radial_at` j, transported to the frame of i
void AffineHeat::solve_lengths() {
  const double to_units = graph_.length_unit() / solution_unit(graph_);
  std::vector<double> radial(unknown_.size());
  lengths_.resize(rhs_.size() * n_);
  for (std::size_t s = 0; s < rhs_.size(); ++s)
    detail::for_each_index(
        n_, threads_, [&](std::size_t i) { radial_at(s, static_cast<Index>(i), radial.data() + (s * n_ + i) * d_); });
  detail::for_each_index(n_, threads_, [&](std::size_t i) {
    const Star star = graph_.star(static_cast<Index>(i));
    const double coefficient = -operators_.tau()[i] * operators_.scaling() * to_units;
    Scratch seen(d_);
    for (std::size_t s = 0; s < rhs_.size(); ++s) {
      double sum = 0;
      for (std::size_t k = 0; k < star.degree(); ++k) {
        const auto j = static_cast<std::size_t>(star.neighbors[k]);
        star.transport(k).apply(radial.data() + (s * n_ + j) * d_, seen.data());
        sum += star.weights[k] *
               (2 * dot(star.log(k), seen.span()) - to_units * dot(star.log(k), star.log(k)) * lambda_[s * n_ + j]);
      }
      lengths_[s * n_ + i] = coefficient * sum;
    }
  });
  for (std::size_t s = 0; s < rhs_.size(); ++s) {
    const RightHandSide& in = rhs_[s];
    const std::vector<double>& given = in.lengths.empty() ? in.squares : in.lengths;
    for (std::size_t k = 0; k < in.vertices.size(); ++k)
      lengths_[s * n_ + static_cast<std::size_t>(in.vertices[k])] += given[k];
  }
  operators_.solve_scalar(lengths_, static_cast<Index>(rhs_.size()), threads_);
}

void AffineHeat::unknown_at(std::size_t source, Index vertex, double* out) const {
  const std::span<const double> x = unknown(source);
  for (std::size_t a = 0; a < d_; ++a) out[a] = x[place_.place(static_cast<std::size_t>(vertex), a)];
}

double AffineHeat::root_mean_square_at(std::size_t source, Index vertex) const {
  if (!has_squares()) return 0;
  return std::sqrt(std::max(0.0, square_at(source, vertex) / lambda(source)[vertex])) * solution_unit(graph_);
}

/// The distance computed from a second moment (q or p), in units of the solution.
double AffineHeat::distance_by(std::size_t source, Index vertex, double second_moment) const {
  const auto i = static_cast<std::size_t>(vertex);
  const double heat = lambda(source)[i];
  Scratch x(d_);
  unknown_at(source, vertex, x.data());
  for (double& component : x.span()) component /= heat;
  const double root_tau = std::sqrt(operators_.tau()[i]) * graph_.length_unit() / solution_unit(graph_);
  return heat_distance(length(x.span()), std::sqrt(std::max(0.0, second_moment / heat)), root_tau);
}

double AffineHeat::distance_at(std::size_t source, Index vertex) const {
  return !has_lengths() ? 0 : distance_by(source, vertex, length_at(source, vertex)) * solution_unit(graph_);
}

void AffineHeat::radial_at(std::size_t source, Index vertex, double* out) const {
  system_.radial(frames(source), vertex, unknown(source), n_, out);
  const std::span r(out, d_);
  const double along = length(r);
  const double wanted = distance_by(source, vertex, square_at(source, vertex)) * lambda(source)[vertex];
  const double stretch = along > 0 ? 1 + trust_in_direction(along, wanted) * (wanted / along - 1) : 1;
  for (double& component : r) component *= stretch;
}

void AffineHeat::displacement_at(std::size_t source, Index vertex, double* out) const {
  system_.radial(frames(source), vertex, unknown(source), n_, out);
  const double heat = lambda(source)[vertex], unit = solution_unit(graph_);
  for (std::size_t a = 0; a < d_; ++a) out[a] = out[a] / heat * unit;
}

void AffineHeat::coordinates_at(std::size_t source, Index vertex, double* phi) const {
  system_.read(frames(source), vertex, unknown(source), n_, phi);
  const double heat = lambda(source)[vertex], unit = solution_unit(graph_);
  for (std::size_t a = 0; a < d_; ++a) phi[a] = phi[a] / heat * unit;
}

}  // namespace ahm
