// Distances unfolded across triangles, as in `LogMap::distance` of this library on meshes.
#include "ahm/maps/wavefront.hpp"
#include "methods/heat_fields.hpp"
#include "methods/method.hpp"

namespace ahm::methods {
namespace {

class UnfoldedDistance final : public Baseline {
 public:
  explicit UnfoldedDistance(const TangentGraph& graph) : graph_(graph), stars_(Wavefront::one_rings(graph)) {}

  std::string_view name() const noexcept override { return "unfolded"; }

  Result solve(Index source) const override {
    check_source(source, graph_.size());
    Wavefront front(graph_, stars_);
    front.add(Source::at_vertex(Vertex(source)));
    front.run();
    Result result;
    for (Index i = 0; i < graph_.size(); ++i) result.distance.push_back(front.distance(Vertex(i)));
    return result;
  }

 private:
  const TangentGraph& graph_;
  std::shared_ptr<const Wavefront::OneRings> stars_;
};

}  // namespace

Method unfolded_distance(const TangentGraph& graph) { return std::make_unique<UnfoldedDistance>(graph); }

}  // namespace ahm::methods
