#include "ahm/surface/mesh_topology.hpp"

namespace ahm {

Report figures(const TopologyReport& t) {
  return {{"components", t.components},
          {"boundary_loops", t.boundary_loops},
          {"orientable", t.orientable},
          {"reoriented", t.reoriented},
          {"unreferenced", t.unreferenced},
          {"non_manifold_edges", t.non_manifold_edges},
          {"non_manifold_vertices", t.non_manifold_vertices}};
}

std::vector<Warning> warnings(const TopologyReport& t) {
  std::vector<Warning> result;
  const auto warn = [&](std::string_view id, Index count) {
    if (count > 0) result.push_back({id, {static_cast<double>(count)}, {}});
  };
  warn("unreferenced", t.unreferenced);
  warn("reoriented", t.reoriented);
  warn("non_manifold_edges", t.non_manifold_edges);
  warn("non_manifold_vertices", t.non_manifold_vertices);
  if (!t.orientable) result.push_back({"not_orientable", {}, {}});
  if (t.components > 1) warn("components", t.components);
  return result;
}

}  // namespace ahm
