#include "ahm/surface/mesh_topology.hpp"

#include <algorithm>
#include <utility>

#include "ahm/surface/detail/gluing.hpp"
#include "ahm/util/disjoint_sets.hpp"

namespace ahm {
namespace {

/// Some faces of a mesh, with their numbers in it.
struct FaceSubset {
  std::vector<Offset> begin{0};
  std::vector<Index> vertices, number;

  FaceList faces() const { return {begin, vertices}; }
};

/// The faces that are not left out.
FaceSubset without(const FaceList& faces, const std::vector<bool>& left_out) {
  FaceSubset result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (left_out[f]) continue;
    result.vertices.insert(result.vertices.end(), faces[f].begin(), faces[f].end());
    result.begin.push_back(static_cast<Offset>(result.vertices.size()));
    result.number.push_back(static_cast<Index>(f));
  }
  return result;
}

}  // namespace

MeshInspection inspect_mesh(Index vertices, const FaceList& faces) {
  MeshInspection result;
  result.topology.vertices = vertices;
  if (vertices < 1 || faces.size() == 0) return result;
  detail::FaceFaults faults = detail::find_faults(vertices, faces);
  std::vector<bool> left_out(faces.size(), false);
  for (const auto* wrong : {&faults.outside, &faults.small, &faults.repeating})
    for (Index f : *wrong) left_out[f] = true;
  result.outside = std::move(faults.outside);
  result.small = std::move(faults.small);
  result.repeating = std::move(faults.repeating);
  FaceSubset rest = without(faces, left_out);
  for (const auto& [later, earlier] : detail::find_duplicates(vertices, rest.faces()))
    if (const Index f = rest.number[later]; !left_out[f]) left_out[f] = true, result.duplicates.push_back(f);
  if (!result.duplicates.empty()) rest = without(faces, left_out);
  if (!rest.number.empty()) result.topology = detail::GluedMesh(vertices, rest.faces(), NonManifold::split).report();
  return result;
}

FaceParts face_parts(Index vertices, const FaceList& faces) {
  detail::Gluing gluing = detail::glue(vertices, faces, NonManifold::split);
  const auto count = static_cast<Index>(faces.size());
  std::vector<Index> face_of(faces.vertices.size());
  for (Index f = 0; f < count; ++f)
    std::fill(face_of.begin() + faces.begin[f], face_of.begin() + faces.begin[f + 1], f);
  detail::DisjointSets joined(faces.size());
  for (std::size_t h = 0; h < face_of.size(); ++h)
    if (const detail::Half other = gluing.partner[h]; other >= 0) joined.join(face_of[h], face_of[other]);
  FaceParts result{std::vector<Index>(faces.size()), std::move(gluing.reversed)};
  for (Index f = 0; f < count; ++f) result.part[f] = joined.root(f);
  return result;
}

Report figures(const TopologyReport& t) {
  return {{"components", t.components},
          {"boundary_loops", t.boundary_loops},
          {"orientable", t.orientable},
          {"reoriented", t.reoriented},
          {"unreferenced", t.unreferenced},
          {"non_manifold_edges", t.non_manifold_edges},
          {"non_manifold_vertices", t.non_manifold_vertices},
          {"added_vertices", t.added_vertices}};
}

std::vector<Warning> warnings(const TopologyReport& t) {
  std::vector<Warning> result;
  const auto warn = [&](std::string_view id, Index count) {
    if (count > 0) result.push_back({id, {static_cast<double>(count)}, {}});
  };
  warn("unreferenced", t.unreferenced);
  warn("reoriented", t.reoriented);
  warn("non_manifold_edges", t.non_manifold_edges);
  if (t.non_manifold_vertices > 0)
    result.push_back({"non_manifold_vertices",
                      {static_cast<double>(t.non_manifold_vertices), static_cast<double>(t.added_vertices)},
                      {}});
  if (!t.orientable) result.push_back({"not_orientable", {}, {}});
  if (t.components > 1) warn("components", t.components);
  return result;
}

}  // namespace ahm
