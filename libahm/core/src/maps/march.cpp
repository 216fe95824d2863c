#include "maps/march.hpp"

#include <string>

#include "ahm/error.hpp"
#include "ahm/maps/straight_line.hpp"
#include "ahm/util/parallel.hpp"
#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "graph/patch.hpp"

namespace ahm {

MarchState March::state() const {
  MarchState state;
  state.statistics = statistics_;
  state.depth = depth_;
  state.accepted = accepted_count_;
  state.front = front_;
  numbers_.visit(
      [&](Index vertex, Index number) {
        if (!states_[number]->accepted) return;
        const std::span known = known_.row(number), found(found_[number], d_ + 2);
        state.vertices.push_back(vertex);
        state.values.insert(state.values.end(), known.begin(), known.end());
        state.values.insert(state.values.end(), found.begin(), found.end());
        state.exponents.push_back(known_.exponents(number));
      },
      [&](Index begin, Index end) {
        if (!state.passed.empty() && state.passed.back() == begin)
          state.passed.back() = end;
        else
          state.passed.insert(state.passed.end(), {begin, end});
      });
  return state;
}

void March::restore(const MarchState& state) {
  const std::size_t known = known_.row_width(), width = known + d_ + 2;
  if (state.values.size() != state.vertices.size() * width || state.exponents.size() != state.vertices.size())
    throw InvalidArgument("the saved state belongs to another march: its size does not fit; start from the source");
  for (std::size_t run = 0; run + 1 < state.passed.size(); run += 2)
    for (Index vertex = state.passed[run]; vertex < state.passed[run + 1]; ++vertex) {
      state_of(vertex);
      forget(vertex);
    }
  for (std::size_t k = 0; k < state.vertices.size(); ++k) {
    state_of(state.vertices[k]).accepted = true;
    const Index number = numbers_.find(state.vertices[k]);
    const auto row = std::span(state.values).subspan(k * width, width);
    known_.set(number, row.first(known), state.exponents[k]);
    found_.grow_to(number + 1);
    std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(known), d_ + 2, found_[number]);
  }
  front_ = state.front;
  statistics_ = state.statistics;
  depth_ = state.depth;
  accepted_count_ = state.accepted;
}

March::March(const TangentGraph& graph, const HeatOptions& options, const MarchScales& scales, Variant variant,
             const MarchReach& reach, unsigned threads, Progress progress, MarchSink* sink, MarchTeam* team,
             MarchGoal goal)
    : graph_(graph),
      options_(options),
      variant_(variant),
      scales_(scales),
      sink_(sink),
      goal_(goal),
      looks_ahead_(!sink && threads > 1 && std::isinf(reach.radius)),
      own_team_(team ? nullptr : std::make_unique<SingleMember>(graph.dimension(), looks_ahead_)),
      team_(team ? *team : *own_team_),
      margin_(march_margin(options.accuracy)),
      step_(std::min(march_step, team_.reach())),
      reach_(reach),
      depth_(step_ + margin_),
      progress_(std::move(progress)),
      threads_(threads),
      d_(static_cast<std::size_t>(graph.dimension())),
      numbers_(graph.size()),
      states_(1),
      known_(graph, system_of(variant), goal != MarchGoal::distances),
      found_(d_ + 2),
      nan_(d_, NAN) {
  options_.progress = {};
  options_.solver = {};  // bands have libahm's own factors
  options_.threads = threads;
}

void March::run(const Source& source, MarchKeeper* keeper) {
  keeper_ = keeper;
  start_ = source_position(graph_, source);
  const std::optional<MarchState> begun = keeper ? keeper->begin() : std::nullopt;
  if (begun) restore(*begun);
  march(begun ? nullptr : &source);
}

void March::run_on(const AffineHeat& heat, std::size_t s, const Source& source) {
  start_ = source_position(graph_, source);
  std::vector<Index> reached;
  for (Index i = 0; i < graph_.size(); ++i)
    if (heat.reached(s, i)) reached.push_back(i);
  for (Index i : reached) take_values(i, accept(i, heat.lambda(s)[i], 0), i, heat, s, 0);
  pass_front(reached);
  drop_out_of_reach();
  march(nullptr);
}

/// The solve of a band. Its heat determines the accepted part and where the next band lies; the other values are computed after that.
struct March::Solve {
  bool is_first;  ///< whether the right-hand side is that of the source
  Band band;
  std::int64_t size;  ///< number of vertices of the bands of all members
  std::vector<Link> links;
  CsrGraph patch;
  std::optional<HeatOperators> operators;
  const HeatSystem* system = nullptr;  ///< the system that `operators` owns
  std::optional<AffineHeat> heat;
  HeatExponents exponents;
  std::vector<Index> near;     ///< places of the accepted vertices
  std::vector<Index> numbers;  ///< numbers of the accepted vertices

  std::vector<Index> accepted() const {
    std::vector<Index> vertices;
    for (const Index k : near) vertices.push_back(band.vertices[k]);
    return vertices;
  }
};

void March::march(const Source* source) {
  std::unique_ptr<Solve> last;  // accepted by its heat; its other values are not yet computed
  while (last || source || team_.sum(static_cast<std::int64_t>(front_.size())) > 0) {
    progress_.step("solve", static_cast<double>(accepted_count_) / graph_.size());
    std::unique_ptr<Solve> next;
    detail::run_both(
        last ? 2 : 1,
        [&] {
          if (last) solve_values(*last);
        },
        [&] { next = solve_heat(source); });
    if (std::exchange(last, nullptr) && drop_out_of_reach()) continue;  // `next` started from a front that has changed
    if (!next) {
      front_.clear();
    } else if (!accept_near(*next)) {
      next->system->check();
      depth_ *= 1.4;  // permanently: if one band is too thin, the next ones would be, too
      continue;
    } else if (looks_ahead_) {
      pass_front(next->accepted());
      last = std::move(next);
    } else {
      solve_values(*next);
      pass_front(next->accepted());
      drop_out_of_reach();
    }
    source = nullptr;
    if (keeper_) keeper_->end_band(*this);
  }
}

/// Computes the next band and its heat, without accepting anything. Null if nothing is ahead.
std::unique_ptr<March::Solve> March::solve_heat(const Source* source) {
  Band band = find_band(source);
  const std::int64_t size = team_.sum(static_cast<std::int64_t>(band.own));
  if (size == 0) return nullptr;

  // A Dirichlet neighbor behind the front adds tau w to the diagonal, and (below) tau w times its values to the right-hand sides.
  std::vector<Link> links;
  CsrGraph patch = cut_out(
      graph_, std::span(band.vertices).first(band.own), [&](Index j) { return place(j); },
      [&](std::size_t k, const Star& star, std::size_t e) {
        if (!accepted(star.neighbors[e])) return 0.0;
        links.push_back({static_cast<Index>(k), e, known_number(star.neighbors[e])});
        return tau(band.vertices[k]) * star.weights[e];
      },
      band.halo.size());
  std::vector<double> times(band.vertices.size(), 0.0);
  for (std::size_t k = 0; k < band.own; ++k) {
    times[k] = tau(band.vertices[k]);
    for (const Index j : patch.star(static_cast<Index>(k)).neighbors)
      if (static_cast<std::size_t>(j) >= band.own) times[j] = times[k];
  }
  auto solve = std::make_unique<Solve>(
      Solve{source != nullptr, std::move(band), size, std::move(links), std::move(patch), {}, {}, {}, {}, {}, {}});
  auto system = team_.system({solve->patch, solve->band.halo, std::move(times)}, options_);
  solve->system = system.get();
  solve->operators = HeatOperatorsAccess::make(std::move(system), solve->patch, Components{});

  RightHandSide right_hand_side;
  if (source) {
    right_hand_side = right_hand_side_of(*source, graph_, *solve->operators, variant_,
                                         [&](Index vertex) { return team_.owns(vertex); });
    for (Index& vertex : right_hand_side.vertices) vertex = place(vertex);
  } else {
    solve->exponents.heat = static_cast<std::int32_t>(team_.greatest(known_.heat_exponent_for(numbers_behind(*solve))));
    right_hand_side = heat_behind(*solve);
  }
  for (Index vertex : solve->band.vertices) state_of(vertex).place = -1;

  solve->heat.emplace(solve->patch, *solve->operators, variant_, std::vector{std::move(right_hand_side)}, threads_);
  solve->heat->diffuse_heat();
  return solve;
}

/// Accepts the near part of a band, determined by its heat. @return false if the band is too thin to accept anything
bool March::accept_near(Solve& solve) {
  ++statistics_.bands;
  statistics_.solved += solve.size;
  statistics_.largest_band = std::max(statistics_.largest_band, static_cast<Index>(solve.size));
  auto near = near_part(solve.band, solve.size, solve.heat->lambda(0));
  if (!near) return false;
  solve.near = std::move(*near);
  for (const Index k : solve.near)
    solve.numbers.push_back(accept(solve.band.vertices[k], solve.heat->lambda(0)[k], solve.exponents.heat));
  return true;
}

/// Computes the other values of the accepted vertices. The next band's heat may be computed at the same time.
void March::solve_values(Solve& solve) {
  AffineHeat& heat = *solve.heat;
  if (!solve.is_first) {
    solve.exponents.frame = static_cast<std::int32_t>(team_.greatest(known_.frame_exponent_for(numbers_behind(solve))));
    add_values_behind(solve, heat.right_hand_side(0));
  }
  if (goal_ != MarchGoal::distances) heat.diffuse_frames();
  heat.solve();
  if (goal_ != MarchGoal::coordinates) heat.solve_squares();
  if (goal_ != MarchGoal::coordinates && !graph_.is_delaunay()) heat.solve_lengths();
  for (std::size_t k = 0; k < solve.near.size(); ++k)
    take_values(solve.band.vertices[solve.near[k]], solve.numbers[k], solve.near[k], heat, 0, solve.exponents.frame);
}

/// Places in the band that are farther than the margin from everything that was left out, measured by the new heat. nullopt if they are too
/// few compared with the size of the band.
std::optional<std::vector<Index>> March::near_part(const Band& band, std::int64_t size,
                                                   std::span<const double> lambda) const {
  auto level_of = [&](Index k) { return lambda[k] > 0 ? -std::log(lambda[k]) : INFINITY; };
  double limit = std::numeric_limits<double>::infinity();
  for (Index k : band.edge)
    if (lambda[k] > 0) limit = std::min(limit, level_of(k) - margin_);
  limit = team_.least(limit);
  const double hottest = lambda.empty() ? 0 : *std::max_element(lambda.begin(), lambda.end());
  const double resolved = -std::log(team_.greatest(hottest)) + step_;
  const bool too_thin = limit < resolved;
  if (std::isfinite(team_.reach())) limit = std::min(limit, resolved);
  std::vector<Index> near;
  std::int64_t own = 0;
  for (std::size_t k = 0; k < band.vertices.size(); ++k)
    if (const auto place = static_cast<Index>(k); std::isinf(limit) || level_of(place) <= limit) {
      near.push_back(place);
      own += k < band.own ? 1 : 0;
    }
  if (too_thin && static_cast<double>(team_.sum(own)) * std::pow(4.0, d_) < static_cast<double>(size))
    return std::nullopt;
  return near;
}

std::vector<Index> March::numbers_behind(const Solve& solve) {
  std::vector<Index> behind;
  for (const Link& link : solve.links) behind.push_back(link.number);
  return behind;
}

/// Dirichlet terms of the accepted neighbors in the band's right-hand side of A.
RightHandSide March::heat_behind(const Solve& solve) const {
  RightHandSide in;
  for (const Link& link : solve.links) {
    if (in.vertices.empty() || in.vertices.back() != link.place) {
      in.vertices.push_back(link.place);
      in.heat.push_back(0);
    }
    in.heat.back() += known_.heat_along(link.number, conductance(solve, link), solve.exponents.heat);
  }
  return in;
}

/// Adds the Dirichlet terms of the accepted neighbors in the other right-hand sides.
void March::add_values_behind(const Solve& solve, RightHandSide& in) const {
  const std::size_t width = graph_.transport_layout().width();
  Index place = -1;
  for (const Link& link : solve.links) {
    if (std::exchange(place, link.place) != link.place) {
      in.frames.resize(in.frames.size() + width);
      in.values.resize(in.values.size() + d_);
      in.translations.resize(in.translations.size() + d_);
      in.squares.push_back(0);
      in.pairs.resize(in.pairs.size() + d_ * d_);
      in.lengths.push_back(0);
    }
    const double through = conductance(solve, link);
    known_.add_to(in, graph_.star(solve.band.vertices[link.place]), link.edge, link.number, through, solve.exponents);
  }
}

double March::conductance(const Solve& solve, const Link& link) const {
  const Index vertex = solve.band.vertices[link.place];
  return solve.operators->scaling() * tau(vertex) * graph_.star(vertex).weights[link.edge];
}

/// Marks a vertex as accepted and stores its heat. @return the number of the vertex
Index March::accept(Index vertex, double lambda, std::int32_t exponent) {
  state_of(vertex).accepted = true;
  accepted_count_ += team_.owns(vertex) ? 1 : 0;
  const Index number = numbers_.find(vertex);
  known_.take_heat(number, lambda, exponent);
  found_.grow_to(number + 1);
  return number;
}

/// Stores the other values of an accepted vertex and passes its result to the sink.
void March::take_values(Index vertex, Index number, Index place, const AffineHeat& heat, std::size_t s,
                        std::int32_t frame_exponent) {
  known_.take_values(number, place, heat, s, frame_exponent);
  const std::span phi(found_[number], d_);
  const bool has_frames = goal_ != MarchGoal::distances;
  if (has_frames)
    heat.coordinates_at(s, place, phi.data());
  else
    heat.displacement_at(s, place, phi.data());
  found_[number][d_] = heat.root_mean_square_at(s, place);
  found_[number][d_ + 1] = heat.distance_at(s, place);
  const bool good = known_.heat(number) > 0 && (!has_frames || heat.frames(s).heat(place) > 0) && all_finite(phi);
  if (!good) std::fill(phi.begin(), phi.end(), NAN);
  if (sink_ && team_.owns(vertex)) sink_->accept(vertex, {phi, found_[number][d_], found_[number][d_ + 1]});
}

/// Adds accepted vertices to the front, and removes vertices without neighbors ahead from it.
void March::pass_front(std::span<const Index> added) {
  for (Index vertex : added)
    if (team_.owns(vertex)) front_.push_back(vertex);
  std::vector<Index> passed;
  std::erase_if(front_, [&](Index vertex) {
    const bool is_passed = !has_neighbors_ahead(vertex);
    if (is_passed && sink_) passed.push_back(vertex);
    return is_passed;
  });
  for (const HaloVertex& next : team_.share(passed)) forget(next.vertex);
  for (Index vertex : passed) forget(vertex);
}

/// Removes vertices without finite values, or out of reach, from the front. @return whether there were any
bool March::drop_out_of_reach() {
  return std::erase_if(front_, [&](Index vertex) { return !is_within_reach(vertex); }) > 0;
}

/// Frees the values of a vertex whose neighbors are all accepted. They are not needed again.
void March::forget(Index vertex) {
  *states_[numbers_.find(vertex)] = {};
  numbers_.forget(vertex);
}

/// Number of an accepted vertex that is a neighbor of one that is not accepted.
Index March::known_number(Index vertex) const {
  const Index number = numbers_.find(vertex);
  if (number < 0) throw InvalidGraph("an edge to vertex " + std::to_string(vertex) + " has no reverse edge");
  return number;
}

March::VertexState& March::state_of(Index vertex) {
  const Index number = numbers_.number(vertex);
  states_.grow_to(numbers_.count());
  return *states_[number];
}

/// Place of a vertex in the current band; -1: not in it.
Index March::place(Index vertex) const {
  const Index number = numbers_.find(vertex);
  return number < 0 ? -1 : states_[number]->place;
}

void March::axes(Index vertex, double* out) const {
  if (accepted(vertex)) return known_.axes(numbers_.find(vertex), out);
  for (std::size_t a = 0; a < d_; ++a)
    for (std::size_t c = 0; c < d_; ++c) out[a * d_ + c] = a == c;
}

/// Allows four edge lengths beyond the radius, because distances by heat are not monotone from vertex to vertex.
bool March::is_within_reach(Index vertex) const {
  const double far = reach_.radius + 4 * scales_.h(vertex) * graph_.length_unit(),
               by_heat = length(coordinates(vertex));
  if (std::isnan(by_heat) || std::isinf(reach_.radius)) return !std::isnan(by_heat);
  if (reach_.distances) return reach_.distances->of(vertex) <= far;
  if (by_heat <= far) return true;
  const std::optional<Frame> frame = start_ ? graph_.frame(vertex) : std::nullopt;
  return frame && ahm::distance(frame->origin, *start_) <= far;
}

bool March::has_neighbors_ahead(Index vertex) const {
  const Star star = graph_.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.weights[e] != 0 && !accepted(star.neighbors[e])) return true;
  return false;
}

namespace {

constexpr float far_away = std::numeric_limits<float>::infinity();

/// Upper bound of heat distances. Vertices that are farther ahead are still visited, in any order.
constexpr double farthest = 1e30;

}  // namespace

/// The vertices ahead of the front within the heat distance `depth_`; own vertices in the order of the graph.
March::Band March::find_band(const Source* source) {
  Band band;
  band.vertices = search(source);
  // In the order of the graph neighbors are close in memory. The order of distance scatters them around the front.
  std::sort(band.vertices.begin(), band.vertices.end());
  band.own = band.vertices.size();
  band.halo = team_.share(band.vertices);
  for (const HaloVertex& next : band.halo) band.vertices.push_back(next.vertex);
  for (std::size_t k = 0; k < band.vertices.size(); ++k) {
    VertexState& own = state_of(band.vertices[k]);
    own.place = static_cast<Index>(k);
    own.tentative = far_away;
  }
  find_edge(band);
  return band;
}

/// Dijkstra's algorithm with the heat distance. It starts from the front, at the levels of the heat there. Each member searches its own
/// vertices, and repeats this while crossings arrive from others. The result does not depend on the distribution of the vertices.
std::vector<Index> March::search(const Source* source) {
  Tentative tentative{*this};
  ShortestPaths<float, Tentative> paths(tentative, far_away);
  std::vector<Ahead> ahead;
  std::vector<Crossing> leaving;
  auto offer = [&](const Ahead& edge, double distance, double tau, double root_tau) {
    const double along = edge_heat_distance(edge.length, edge.weight, tau, root_tau,
                                            [&] { return heat_diagonal(graph_, edge.vertex, tau); });
    // Negative weights may give negative lengths, with which the search would not end.
    paths.offer(edge.vertex, static_cast<float>(std::min(distance + (along < 0 ? 0 : along), farthest)));
  };
  auto spread = [&](Index from, double distance) {
    const Star star = graph_.star(from);
    ahead.clear();  // a copy: the star is valid until the next call of graph_.star
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0 && may_be_nearer(star.neighbors[e], distance))
        ahead.push_back({star.neighbors[e], star.weights[e], length(star.log(e))});
    const double tau = this->tau(from), root_tau = std::sqrt(tau);  // equal at both ends of an edge
    for (const Ahead& edge : ahead)
      if (team_.owns(edge.vertex))
        offer(edge, distance, tau, root_tau);
      else
        leaving.push_back({edge.vertex, distance, edge.length, edge.weight});
  };
  auto cross = [&] {
    if (team_.sum(static_cast<std::int64_t>(leaving.size())) == 0) return false;
    for (const Crossing& edge : team_.cross(leaving)) {
      const double tau = this->tau(edge.vertex);
      offer({edge.vertex, edge.weight, edge.length}, edge.distance, tau, std::sqrt(tau));
    }
    leaving.clear();
    return true;
  };
  if (source) {
    for (std::size_t k = 0; k < source->vertices().size(); ++k)
      if (const Index vertex = source->vertices()[k].index; source->weights()[k] > 0 && team_.owns(vertex))
        paths.offer(vertex, 0);
  } else {
    double base = std::numeric_limits<double>::infinity();
    for (Index vertex : front_) base = std::min(base, known_.level(numbers_.find(vertex)));
    base = team_.least(base);
    for (Index vertex : front_)
      if (const double beyond = known_.level(numbers_.find(vertex)) - base; beyond <= depth_) spread(vertex, beyond);
  }
  cross();

  std::vector<Index> found, touched;
  const double limit = team_.least(paths.empty() ? far_away : paths.least()) + depth_;
  do
    paths.run([&](Index vertex, float distance) {
      if (distance > limit) return touched.push_back(vertex);
      if (VertexState& own = state_of(vertex); own.place < 0) {
        own.place = 0;
        found.push_back(vertex);
      }
      spread(vertex, distance);
    });
  while (cross());
  for (Index vertex : touched) state_of(vertex).tentative = far_away;
  return found;
}

/// Whether a vertex is ahead of the front and the search has no path to it that is as short as `distance`.
bool March::may_be_nearer(Index vertex, double distance) const {
  const Index number = numbers_.find(vertex);
  if (number < 0) return number != ReachedNumbers::forgotten;
  return !states_[number]->accepted && !(states_[number]->tentative <= distance);
}

/// Finds the places in the band that have neighbors neither behind the front nor in the band.
void March::find_edge(Band& band) {
  for (std::size_t k = 0; k < band.own; ++k) {
    const Star star = graph_.star(band.vertices[k]);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      if (star.weights[e] == 0 || accepted(j) || place(j) >= 0) continue;
      band.edge.push_back(static_cast<Index>(k));
      break;
    }
  }
}

}  // namespace ahm
