#include "ahm-mpi/mpi_team.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ahm-mpi/petsc_system.hpp"

namespace ahm::tiles::mpi {
namespace {

/// Smallest reach, heat distance. Thinner bands would consist mostly of their margin.
constexpr double least_reach = 4;

/// Safety margin of the reach, heat distance, for rounding errors of badly conditioned systems and of many bands.
constexpr double lost_to_rounding = 2;

}  // namespace

MpiTeam::MpiTeam(MPI_Comm ranks, const TiledGraph& graph, std::vector<int> owner_of_tile, double accuracy)
    : ranks_(ranks),
      graph_(graph),
      owner_of_tile_(std::move(owner_of_tile)),
      reach_(std::max(least_reach, std::log(accuracy / residual_for(accuracy)) - lost_to_rounding)) {
  MPI_Comm_rank(ranks, &rank_);
  MPI_Comm_size(ranks, &size_);
}

double MpiTeam::greatest(double value) {
  ++traffic_.reductions;
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, ranks_);
  return value;
}

std::int64_t MpiTeam::sum(std::int64_t value) {
  ++traffic_.reductions;
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, ranks_);
  return value;
}

/// Sends values to the other ranks. @param to  values for each rank. @return the values that other ranks sent
template <class T>
std::vector<T> MpiTeam::exchange(const std::vector<std::vector<T>>& to) {
  const auto ranks = static_cast<std::size_t>(size_);
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  std::vector<int> counts(ranks), places(ranks), counts_in(ranks), places_in(ranks);
  std::vector<T> out;
  for (std::size_t r = 0; r < ranks; ++r) {
    counts[r] = static_cast<int>(to[r].size());
    places[r] = static_cast<int>(out.size());
    out.insert(out.end(), to[r].begin(), to[r].end());
    traffic_.search_messages += counts[r] > 0 ? 1 : 0;
  }
  traffic_.search_bytes += static_cast<std::int64_t>(out.size() * sizeof(T));
  MPI_Alltoall(counts.data(), 1, MPI_INT, counts_in.data(), 1, MPI_INT, ranks_);
  int all = 0;
  for (std::size_t r = 0; r < ranks; ++r) places_in[r] = std::exchange(all, all + counts_in[r]);
  std::vector<T> in(static_cast<std::size_t>(all));
  MPI_Alltoallv(out.data(), counts.data(), places.data(), type, in.data(), counts_in.data(), places_in.data(), type,
                ranks_);
  MPI_Type_free(&type);
  return in;
}

std::vector<Crossing> MpiTeam::cross(std::span<const Crossing> leaving) {
  std::vector<std::vector<Crossing>> to(static_cast<std::size_t>(size_));
  for (const Crossing& crossing : leaving) to[static_cast<std::size_t>(owner(crossing.vertex))].push_back(crossing);
  return exchange(to);
}

std::vector<HaloVertex> MpiTeam::share(std::span<const Index> vertices) {
  std::int64_t mine = static_cast<std::int64_t>(vertices.size()), first = 0;
  MPI_Scan(&mine, &first, 1, MPI_INT64_T, MPI_SUM, ranks_);
  first -= mine;
  std::vector<std::vector<HaloVertex>> to(static_cast<std::size_t>(size_));
  for (std::size_t k = 0; k < vertices.size(); ++k)
    for (Index j : graph_.star(vertices[k]).neighbors) {
      auto& owner_list = to[static_cast<std::size_t>(owner(j))];
      if (&owner_list != &to[static_cast<std::size_t>(rank_)] &&
          (owner_list.empty() || owner_list.back().vertex != vertices[k]))
        owner_list.push_back({vertices[k], first + static_cast<std::int64_t>(k)});
    }
  return exchange(to);
}

std::unique_ptr<const HeatSystem> MpiTeam::system(BandPart part, const HeatOptions& options) {
  const auto own = static_cast<std::int64_t>(part.graph.size()) - static_cast<std::int64_t>(part.halo.size());
  largest_part_ = std::max(largest_part_, own);
  solved_ += own;
  std::vector<char> is_neighbor(static_cast<std::size_t>(size_), 0);
  for (const HaloVertex& next : part.halo) is_neighbor[static_cast<std::size_t>(owner(next.vertex))] = 1;
  traffic_.neighbors = std::count(is_neighbor.begin(), is_neighbor.end(), 1);
  return petsc_system(ranks_, std::move(part), options, traffic_);
}

}  // namespace ahm::tiles::mpi
