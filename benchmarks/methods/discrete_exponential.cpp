// DEM: Dijkstra's algorithm sums edge vectors, each turned to the frame of the source.
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

class DiscreteExponential final : public Baseline {
 public:
  DiscreteExponential(const TangentGraph& graph, const DiscreteExponentialOptions& options)
      : graph_(graph), options_(options) {
    if (options.turn == FrameTurn::in_space && (graph.dimension() != 2 || graph.size() == 0 || !graph.frame(0)))
      throw InvalidArgument(
          "discrete_exponential: the graph is not a surface in space with frames; use FrameTurn::along_path instead");
  }

  std::string_view name() const noexcept override { return "DEM"; }
  Result solve(Index source) const override;

 private:
  const TangentGraph& graph_;
  DiscreteExponentialOptions options_;
};

using Row3 = Eigen::RowVector3d;

Row3 row(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// 2 x 2 matrix from components in frame `from` to components in frame `to`, after the smallest rotation from one normal to
/// the other. Opposite normals: half a turn about the x axis of `to`.
Eigen::Matrix2d turn_in_space(const Frame& from, const Frame& to) {
  const Eigen::Vector3d m = row(from.normal), n = row(to.normal);
  const double cosine = m.dot(n);
  Eigen::Matrix3d rotation = Eigen::AngleAxisd(std::numbers::pi, row(to.x).transpose()).toRotationMatrix();
  if (cosine > -1 + 1e-12) rotation = Eigen::Quaterniond::FromTwoVectors(m, n).toRotationMatrix();
  Eigen::Matrix<double, 3, 2> axes_from, axes_to;
  axes_from << row(from.x).transpose(), row(from.y).transpose();
  axes_to << row(to.x).transpose(), row(to.y).transpose();
  return axes_to.transpose() * rotation * axes_from;
}

/// One run of Dijkstra's algorithm, in graph units.
class Propagation {
 public:
  Propagation(const TangentGraph& graph, const DiscreteExponentialOptions& options)
      : graph_(graph),
        options_(options),
        d_(static_cast<std::size_t>(graph.dimension())),
        path_(static_cast<std::size_t>(graph.size()), HUGE_VAL),
        settled_(path_.size(), false),
        coordinates_(path_.size() * d_, nan),
        turns_(path_.size() * d_ * d_),
        vector_(d_) {}

  std::vector<double> run(Index source) {
    paths_.offer(source, 0);
    paths_.run([&](Index i, double length) {
      const Star star = graph_.star(i);
      i == source ? start(i) : place(i, star);
      settled_[i] = true;
      for (std::size_t e = 0; e < star.degree(); ++e) paths_.offer(star.neighbors[e], length + log_length(star, e));
    });
    return std::move(coordinates_);
  }

 private:
  void start(Index source) {
    if (options_.turn == FrameTurn::in_space) source_frame_ = *graph_.frame(source);
    for (std::size_t a = 0; a < d_; ++a) {
      at(source)[a] = 0;
      turn(source, a)[a] = 1;
    }
  }

  /// u_i = u_q - Q_q R_iq e_iq for the predecessor q on the shortest path, or averaged over all settled neighbors q.
  void place(Index i, const Star& star) {
    double shortest = HUGE_VAL, weights = 0;
    std::size_t last_edge = 0;
    for (std::size_t a = 0; a < d_; ++a) at(i)[a] = 0;
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index q = star.neighbors[e];
      if (!settled_[q]) continue;
      const double edge = log_length(star, e), length = path_[q] + edge;
      if (length < shortest) shortest = length, last_edge = e;
      if (options_.upwind_average && edge > 0) add_prediction(i, star, e, 1 / edge), weights += 1 / edge;
    }
    for (std::size_t a = 0; a < d_ && weights > 0; ++a) at(i)[a] /= weights;
    if (weights == 0) add_prediction(i, star, last_edge, 1.0);
    if (options_.turn == FrameTurn::in_space) {
      Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(turn(i, 0)) =
          turn_in_space(*graph_.frame(i), source_frame_);
      return;
    }
    // Q_i = Q_q R_iq, row by row: R_qi transports the rows, which are vectors at q, to i.
    for (std::size_t a = 0; a < d_; ++a)
      carry_here(graph_, star, last_edge, turn(star.neighbors[last_edge], a), turn(i, a));
  }

  void add_prediction(Index i, const Star& star, std::size_t e, double weight) {
    const Index q = star.neighbors[e];
    carry_there(graph_, star, e, star.log(e).data(), vector_.data());
    for (std::size_t a = 0; a < d_; ++a) {
      double turned = 0;
      for (std::size_t b = 0; b < d_; ++b) turned += turn(q, a)[b] * vector_[b];
      at(i)[a] += weight * (at(q)[a] - turned);
    }
  }

  double* at(Index i) { return &coordinates_[static_cast<std::size_t>(i) * d_]; }
  /// Row a of Q_i, the matrix from components in frame i to the source's frame.
  double* turn(Index i, std::size_t a) { return &turns_[(static_cast<std::size_t>(i) * d_ + a) * d_]; }

  const TangentGraph& graph_;
  DiscreteExponentialOptions options_;
  Frame source_frame_{};
  std::size_t d_;
  std::vector<double> path_;  ///< length of the shortest edge path found so far
  std::vector<bool> settled_;
  std::vector<double> coordinates_, turns_, vector_;
  ShortestPaths<double, std::vector<double>> paths_{path_, HUGE_VAL};
};

Result DiscreteExponential::solve(Index source) const {
  check_source(source, graph_.size());
  Result result{Propagation(graph_, options_).run(source), {}};
  for (double& x : result.coordinates) x *= graph_.length_unit();
  const int d = graph_.dimension();
  for (Index i = 0; i < graph_.size(); ++i)
    result.distance.push_back(
        Eigen::Map<const Eigen::VectorXd>(&result.coordinates[static_cast<std::size_t>(i) * d], d).norm());
  return result;
}

}  // namespace

Method discrete_exponential(const TangentGraph& graph, const DiscreteExponentialOptions& options) {
  return std::make_unique<DiscreteExponential>(graph, options);
}

}  // namespace ahm::methods
