/// \file
/// The seam between a march and the machines that it runs on: what it asks of the others that march with it.
///
/// Each member of a team marches over vertices of its own, with the same code, and knows of the others' vertices those next
/// to its own: the halo. Bands are chosen by one search of shortest paths that goes from member to member; a band's system
/// is solved by all together; what is accepted follows from numbers that all know. A member that is alone owns everything.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/heat/heat_options.hpp"
#include "heat/heat_system.hpp"

namespace ahm {

/// An edge along which the search for a band comes to a vertex of another member.
struct Crossing {
  Index vertex;
  double distance;  ///< heat distance of the near end
  double length, weight;
};

/// A vertex of another member next to one's own.
struct HaloVertex {
  Index vertex;
  std::int64_t row;  ///< among the band's vertices, those of the first member first
};

/// A member's part of a band as a graph: its own vertices with their stars, then the halo's, without edges and of mass 1.
struct BandPart {
  const CsrGraph& graph;
  std::span<const HaloVertex> halo;
  std::vector<double> tau;  ///< of each vertex, the same at both ends of an edge
};

/// All but `owns` and `reach` are called by all members at the same time, as often, in the same order.
class MarchTeam {
 public:
  virtual ~MarchTeam() = default;

  virtual bool owns(Index vertex) const = 0;

  /// Of the members' values.
  virtual double least(double value) = 0;
  virtual double greatest(double value) = 0;
  virtual std::int64_t sum(std::int64_t value) = 0;

  /// Hands crossings over to the owners of their vertices. @return those that come to one's own
  virtual std::vector<Crossing> cross(std::span<const Crossing> leaving) = 0;
  /// Tells of own vertices to all who own a neighbour of them; row i is that of vertices[i]. @return what others tell
  virtual std::vector<HaloVertex> share(std::span<const Index> vertices) = 0;

  /// Heat distance from the largest value of a solution to where it is right: shallower bands are accepted where errors are
  /// relative to the largest value. Infinite where each number is right by itself.
  virtual double reach() const = 0;
  /// Solves on own rows; of the halo it fills in what the owners found.
  /// @throws as `HeatOperators`
  virtual std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) = 0;
};

/// A team of one, which solves by factors in the plane and by conjugate gradients in volumes, where the factors of a band
/// would fill the memory.
class Alone final : public MarchTeam {
 public:
  /// @param heat_first  whether B is wanted later than A, while the next band's A is under way
  explicit Alone(int dimension, bool heat_first = false) : iterative_(dimension > 2), heat_first_(heat_first) {}
  bool owns(Index) const override { return true; }
  double least(double value) override { return value; }
  double greatest(double value) override { return value; }
  std::int64_t sum(std::int64_t value) override { return value; }
  std::vector<Crossing> cross(std::span<const Crossing>) override { return {}; }
  std::vector<HaloVertex> share(std::span<const Index>) override { return {}; }
  /// Measured: the cost of a vertex does not grow with a band's depth, but what has decayed further loses digits.
  double reach() const override { return iterative_ ? 8 : std::numeric_limits<double>::infinity(); }
  std::unique_ptr<const HeatSystem> system(BandPart part, const HeatOptions& options) override {
    return (iterative_    ? iterative_system
            : heat_first_ ? heat_first_system
                          : factored_system)(part.graph, std::move(part.tau), options);
  }

 private:
  bool iterative_, heat_first_;
};

}  // namespace ahm
