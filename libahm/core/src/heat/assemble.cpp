#include "heat/assemble.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace ahm {
namespace {

/// Column i of the upper triangles: the edges of star i that lead to smaller vertices, then the diagonal.
class ColumnWriter {
 public:
  ColumnWriter(const TangentGraph& graph, std::span<const double> tau, double scaling)
      : d_(graph.dimension()),
        layout_(graph.transport_layout()),
        complex_(layout_.kind == TransportKind::rotation2),
        tau_(tau),
        scaling_(scaling) {
    const auto n = static_cast<std::size_t>(graph.size());
    const auto entries = static_cast<std::size_t>(graph.edge_count()) / 2 + n;
    const std::size_t blocks = complex_ ? 1 : static_cast<std::size_t>(d_) * d_;
    B_.is_complex = complex_;
    A_.column_begin.reserve(n + 1);
    B_.column_begin.reserve((complex_ ? n : n * d_) + 1);
    A_.rows.reserve(entries);
    A_.values.reserve(entries);
    B_.rows.reserve(entries * blocks);
    B_.values.reserve(entries * (complex_ ? 2 : blocks));
    A_.column_begin.push_back(0);
    B_.column_begin.push_back(0);
  }

  void add_column(Index i, double mass, const Star& star) {
    gather(i, star);
    double diagonal = mass;
    for (double w : star.weights) diagonal += tau_[i] * w;
    diagonal *= scaling_;
    A_.rows.insert(A_.rows.end(), columns_.begin(), columns_.end());
    A_.values.insert(A_.values.end(), scalar_.begin(), scalar_.end());
    A_.rows.push_back(i);
    A_.values.push_back(diagonal);
    A_.column_begin.push_back(static_cast<Offset>(A_.rows.size()));
    complex_ ? add_complex_column(i, diagonal) : add_block_columns(i, diagonal);
  }

  AssembledOperators take() { return {std::move(A_), std::move(B_)}; }

 private:
  /// Sums parallel edges: columns_ the neighbours j < i ascending, scalar_ the entries A_ji, blocks_ the entries B_ji.
  void gather(Index i, const Star& star) {
    order_.clear();
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.neighbors[e] < i && star.weights[e] != 0) order_.emplace_back(star.neighbors[e], e);
    std::sort(order_.begin(), order_.end());
    columns_.clear();
    scalar_.clear();
    blocks_.clear();
    const std::size_t width = layout_.width();
    for (const auto& [j, e] : order_) {
      if (columns_.empty() || columns_.back() != j) {
        columns_.push_back(j);
        scalar_.push_back(0);
        blocks_.insert(blocks_.end(), width, 0.0);
      }
      const double entry = -scaling_ * tau_[i] * star.weights[e];
      scalar_.back() += entry;
      // B_ji gains -tau w R_ij, the inverse of the star's R_ji.
      star.transport(e).add_inverse(entry, blocks_.data() + blocks_.size() - width);
    }
  }

  void add_complex_column(Index i, double diagonal) {
    B_.rows.insert(B_.rows.end(), columns_.begin(), columns_.end());
    B_.values.insert(B_.values.end(), blocks_.begin(), blocks_.end());
    B_.rows.push_back(i);
    B_.values.insert(B_.values.end(), {diagonal, 0.0});
    B_.column_begin.push_back(static_cast<Offset>(B_.rows.size()));
  }

  void add_block_columns(Index i, double diagonal) {
    for (int b = 0; b < d_; ++b) {
      for (std::size_t k = 0; k < columns_.size(); ++k)
        for (int a = 0; a < d_; ++a) {
          B_.rows.push_back(static_cast<Offset>(columns_[k]) * d_ + a);
          B_.values.push_back(blocks_[(k * d_ + a) * d_ + b]);
        }
      B_.rows.push_back(static_cast<Offset>(i) * d_ + b);
      B_.values.push_back(diagonal);
      B_.column_begin.push_back(static_cast<Offset>(B_.rows.size()));
    }
  }

  int d_;
  TransportLayout layout_;
  bool complex_;  ///< B is n x n complex, not n d x n d real: the matrices differ in kind
  std::span<const double> tau_;
  double scaling_;
  SparseUpper A_, B_;
  std::vector<std::pair<Index, std::size_t>> order_;  ///< edges, by where they lead
  std::vector<Offset> columns_;
  std::vector<double> scalar_, blocks_;
};

}  // namespace

AssembledOperators assemble(const TangentGraph& graph, std::span<const double> tau, double scaling) {
  ColumnWriter writer(graph, tau, scaling);
  for (Index i = 0; i < graph.size(); ++i) writer.add_column(i, graph.mass(i), graph.star(i));
  return writer.take();
}

}  // namespace ahm
