/// \file
/// Vertices around others, as often as wanted, at a cost that does not depend on the size of the graph.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
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
#include "cholesky/blas.hpp"
#include "heat/component_scales.hpp"
#include "heat/heat_system.hpp"
#include "maps/affine_heat.hpp"

namespace ahm {

/// n values that are zero until written, of which only those written take memory.
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

/// Shortest paths along edges from many starts, to a limit; leaves no trace behind.
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
  SparseArray<double> known_;  ///< 1 + distance, 0: none
  ShortestPaths<double, SparseArray<double>> paths_{known_, 0.0};
  std::vector<Index> touched_;
};

/// Groups of sources near each other: the first that has no group yet, and those around it.
/// @param reach  how far along edges (graph units) a seed looks for others, given its number
/// @return the numbers of the sources of each group
std::vector<std::vector<Index>> groups_of(const TangentGraph& graph, std::span<const Source> sources,
                                          const std::function<double(Index seed)>& reach);

/// A patch with its natural boundary.
struct Patch {
  std::vector<Index> vertices;  ///< of the whole graph, ascending; their places there are the patch's own numbers
  std::vector<Index> edge;      ///< the patch's numbers of those with neighbours outside, ascending
  CsrGraph graph;
  std::vector<Source> sources;  ///< in the patch's numbers
};

/// A patch, its factors with the diffusion times of the whole graph, and the maps on it.
struct PatchMaps : Patch {
  PatchMaps(Patch patch, std::vector<double> tau, const DiffusionOptions& options)
      : Patch(std::move(patch)),
        operators(HeatOperatorsAccess::make(factored_system(graph, std::move(tau), options.factor()), graph, {})) {}
  PatchMaps(const PatchMaps&) = delete;
  PatchMaps& operator=(const PatchMaps&) = delete;

  HeatOperators operators;
  std::optional<AffineHeat> heat;  ///< solved, without squares
};

/// Cuts out patches and solves on them, one after the other.
class PatchSolver {
 public:
  /// @param options  t_coef and variant count. All three must outlive this object.
  PatchSolver(const TangentGraph& graph, const ComponentScales& scales, const DiffusionOptions& options);

  /// The patch of all vertices within `limit` along edges (graph units) of any source.
  Patch cut(std::span<const Source> sources, double limit);
  std::unique_ptr<PatchMaps> solve(Patch patch) const;
  /// The largest sqrt(tau) at a vertex of the sources, graph units.
  double sqrt_tau(std::span<const Source> sources) const;

 private:
  const TangentGraph& graph_;
  const ComponentScales& scales_;
  DiffusionOptions options_;
  Ball ball_;
  SparseArray<Index> place_;  ///< 1 + place in the patch at hand, 0: outside
};

/// The checks of what is solved for on patches.
/// @throws InvalidGraph, InvalidArgument
void check_patches(const TangentGraph& graph, std::span<const Source> sources, const DiffusionOptions& options,
                   double margin);

/// Sources whose patches overlap anyway. @param extent  how far along edges (graph units) each map goes
std::vector<std::vector<Index>> patch_groups(const TangentGraph& graph, const ComponentScales& scales,
                                             std::span<const Source> sources, std::span<const double> extent,
                                             const DiffusionOptions& options, double margin);

/// Calls work(worker, group) for every group, a few at a time by each thread; `make` makes the worker of a thread.
/// @param progress  stage "solve"
template <class Make, class Work>
void share_groups(const std::vector<std::vector<Index>>& groups, unsigned threads, const Progress& progress,
                  const Make& make, const Work& work) {
  using Worker = decltype(make());
  const OneBlasThread one_thread;
  std::mutex mutex;
  std::vector<Worker> idle;
  Offset done = 0;
  const Offset at_once = groups.size() < 64 ? 1 : 8;
  detail::parallel_chunks(static_cast<Offset>(groups.size()), at_once, threads, [&](Offset begin, Offset end) {
    Worker worker;
    {
      std::scoped_lock lock(mutex);
      if (!idle.empty()) worker = std::move(idle.back()), idle.pop_back();
    }
    if (!worker) worker = make();
    for (Offset g = begin; g < end; ++g) work(*worker, groups[static_cast<std::size_t>(g)]);
    std::scoped_lock lock(mutex);
    idle.push_back(std::move(worker));
    done += end - begin;
    progress.step("solve", static_cast<double>(done) / static_cast<double>(groups.size()));
  });
}

}  // namespace ahm
