/// \file
/// Small steps that several of the methods share.
#pragma once

#include <Eigen/Dense>
#include <limits>
#include <span>
#include <vector>

#include "ahm/graph/tangent_graph.hpp"
#include "ahm/heat/heat_operators.hpp"

namespace ahm::methods {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Heat put in at a source, and the least that counts as arrived: far from the ends of double precision.
constexpr double source_heat = 0x1p900;
constexpr double least_heat = 0x1p-60;

/// @throws InvalidArgument when the source is no vertex
void check_source(Index source, Index size);

/// Components in frame i of a vector at the neighbour j across edge `edge` of the star of i: R_ji x.
void carry_here(const TangentGraph& graph, const Star& star, std::size_t edge, const double* there, double* here);
/// The other way: R_ji^-1 x.
void carry_there(const TangentGraph& graph, const Star& star, std::size_t edge, const double* here, double* there);

/// Lengths |e_ij|.
double log_length(const Star& star, std::size_t edge);

/// Heat from the vertex `source`, A^-1 delta.
std::vector<double> scalar_heat(const HeatOperators& heat, Index source);

/// The unit normals of a small circle (sphere) about the source, as a right-hand side for B: at every neighbour j the
/// direction e_pj / |e_pj| carried to j, with the measure w_pj |e_pj| of the dual face between them.
void add_outward_circle(const TangentGraph& graph, Index source, std::span<double> field);

/// Makes every vector one long; zero where its length is below `least_heat`.
void normalize(std::span<double> field, int dimension);

/// The gradient of a function over the star of a vertex: least squares of the slopes along its edges, which gives
/// linear functions exactly on any flat star that spans R^d. Where it does not span, the least gradient.
class StarGradient {
 public:
  explicit StarGradient(int dimension);

  /// The gradient of the f whose increments along the edges are given; an increment that is not finite is left out.
  const Eigen::VectorXd& fit(const Star& star, std::span<const double> increments);
  /// Column e: the gradient per increment along edge e.
  Eigen::MatrixXd coefficients(const Star& star);

 private:
  template <class Use>
  void factor(const Star& star, const Use& use);

  Eigen::MatrixXd normal_;
  Eigen::VectorXd slopes_, gradient_;
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

/// Distances f - f[source] in world units, NaN where `reached` is false.
template <class Reached>
std::vector<double> distances_from(std::vector<double> f, Index source, double length_unit, const Reached& reached) {
  const double zero = f[source];
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = reached(i) ? (f[i] - zero) * length_unit : nan;
  return f;
}

}  // namespace ahm::methods
