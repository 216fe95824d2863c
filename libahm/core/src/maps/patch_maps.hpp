/// \file
/// Solves for the maps of many sources on patches of a graph. The cost per patch does not depend on the size of the graph.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ahm/graph/csr_graph.hpp"
#include "ahm/graph/tangent_graph.hpp"
#include "ahm/maps/source.hpp"
#include "ahm/progress.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {

/// n values, initially zero. Memory is used only near the values that were written.
template <class T>
class SparseArray {
 public:
  explicit SparseArray(std::size_t n) : values_(static_cast<T*>(std::calloc(std::max<std::size_t>(n, 1), sizeof(T)))) {
    if (!values_) throw std::bad_alloc();
  }
  T& operator[](Index i) { return values_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T[], Free> values_;
};

/// Dijkstra's algorithm within a limit, for many searches on the same graph. The cost of a search does not depend on the size of the graph.
class Ball {
 public:
  explicit Ball(const TangentGraph& graph) : graph_(graph), known_(static_cast<std::size_t>(graph.size())) {}

  /// Calls visit(vertex, distance) in order of distance for all vertices within `limit` (graph units) of the starts, until it
  /// returns false.
  template <class Visit>
  void grow(std::span<const Vertex> starts, double limit, const Visit& visit) {
    for (Vertex start : starts) offer(start.index, 0);
    bool more = true;
    paths_.run([&](Index vertex, double key) {
      if (!more || !(more = visit(vertex, key - 1))) return;
      const Star star = graph_.star(vertex);
      for (std::size_t e = 0; e < star.degree(); ++e)
        if (const double next = key - 1 + length(star.log(e)); star.weights[e] != 0 && next <= limit)
          offer(star.neighbors[e], next);
    });
    for (Index vertex : touched_) known_[vertex] = 0;
    touched_.clear();
  }

 private:
  void offer(Index vertex, double distance) {
    if (known_[vertex] == 0) touched_.push_back(vertex);
    paths_.offer(vertex, 1 + distance);
  }

  const TangentGraph& graph_;
  SparseArray<double> known_;  ///< 1 + distance; 0: no distance
  ShortestPaths<double, SparseArray<double>> paths_{known_, 0.0};
  std::vector<Index> touched_;
};

/// Groups nearby sources. Each group consists of the first source without a group, its seed, and sources around it.
/// @param reach  reach(seed): largest length of the edge path from the seed to the other sources, graph units
/// @return the numbers of the sources of each group
std::vector<std::vector<Index>> groups_of(const TangentGraph& graph, std::span<const Source> sources,
                                          const std::function<double(Index seed)>& reach);

/// A subgraph with a natural boundary.
struct Patch {
  std::vector<Index> vertices;  ///< vertices of the whole graph, ascending; vertices[k] is vertex k of the patch
  std::vector<Index> edge;      ///< vertices of the patch that have neighbors outside, ascending
  CsrGraph graph;
  std::vector<Source> sources;  ///< sources, in the numbers of the patch
};

/// A patch, its factored operators, and the maps on it. The diffusion times are those of the whole graph.
struct PatchMaps : Patch {
  PatchMaps(Patch patch, std::vector<double> tau, const DiffusionOptions& options)
      : Patch(std::move(patch)),
        operators(HeatOperatorsAccess::make(factored_system(graph, std::move(tau), options.factor()), graph, {})) {}
  PatchMaps(const PatchMaps&) = delete;
  PatchMaps& operator=(const PatchMaps&) = delete;

  HeatOperators operators;
  std::optional<AffineHeat> heat;  ///< after `AffineHeat::solve`, without second moments
};

/// Cuts out patches and solves on them, one after the other.
class PatchSolver {
 public:
  /// Graph and scales must outlive this object.
  /// @param options  t_coef and variant are used
  PatchSolver(const TangentGraph& graph, const ComponentScales& scales, const DiffusionOptions& options);

  /// The patch of all vertices with an edge path of at most `limit` (graph units) from a source.
  Patch cut(std::span<const Source> sources, double limit);
  /// Factors the operators of a patch and solves for the maps of its sources.
  std::unique_ptr<PatchMaps> solve(Patch patch) const;
  /// The largest sqrt(tau) at a vertex of the sources, graph units.
  double sqrt_tau(std::span<const Source> sources) const;

 private:
  const TangentGraph& graph_;
  const ComponentScales& scales_;
  DiffusionOptions options_;
  Ball ball_;
  SparseArray<Index> place_;  ///< 1 + number in the current patch; 0: outside
};

/// Checks the arguments of solves on patches.
/// @throws InvalidGraph, InvalidArgument
void check_patches(const TangentGraph& graph, std::span<const Source> sources, const DiffusionOptions& options,
                   double margin);

/// Groups sources whose patches overlap.
/// @param extent  length of the longest edge path in each map, graph units
std::vector<std::vector<Index>> patch_groups(const TangentGraph& graph, const ComponentScales& scales,
                                             std::span<const Source> sources, std::span<const double> extent,
                                             const DiffusionOptions& options, double margin);

/// Distributes the groups over threads and calls work(worker, group) for each group.
/// @param make      make(): a new worker; each thread uses its own
/// @param progress  stage "solve"
template <class Make, class Work>
void share_groups(const std::vector<std::vector<Index>>& groups, unsigned threads, const Progress& progress,
                  const Make& make, const Work& work) {
  using Worker = decltype(make());
  detail::Mutex mutex;
  std::vector<Worker> idle;
  Offset done = 0;
  const Offset at_once = groups.size() < 64 ? 1 : 8;
  detail::parallel_chunks(static_cast<Offset>(groups.size()), at_once, threads, [&](Offset begin, Offset end) {
    Worker worker;
    {
      const detail::Lock lock(mutex);
      if (!idle.empty()) worker = std::move(idle.back()), idle.pop_back();
    }
    if (!worker) worker = make();
    for (Offset g = begin; g < end; ++g) work(*worker, groups[static_cast<std::size_t>(g)]);
    const detail::Lock lock(mutex);
    idle.push_back(std::move(worker));
    done += end - begin;
    progress.step("solve", static_cast<double>(done) / static_cast<double>(groups.size()));
  });
}

}  // namespace ahm
