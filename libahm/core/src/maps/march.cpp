#include "maps/march.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ahm/util/shortest_paths.hpp"
#include "ahm/util/small_math.hpp"
#include "graph/patch.hpp"
#include "heat/blas_control.hpp"
#include "heat/heat_system.hpp"

namespace ahm {
namespace {

/// Heat distance accepted per band, where the front is as regular as the graph's edges. Measured: deeper bands cost more
/// fill per vertex, thinner ones solve each vertex more often.
constexpr double default_step = 24;

/// The same where bands are solved iteratively: the cost of a vertex does not grow with the band's depth, but what has
/// decayed further loses digits.
constexpr double iterative_step = 8;

constexpr float far_away = std::numeric_limits<float>::infinity();

/// An edge to a vertex that is not accepted yet.
struct Ahead {
  Index vertex;
  double weight, length;
};

/// How much of the decay exp(-x) of heat an edge brings: its length over sqrt(tau), or what the one edge lets through at
/// the least, where it is far longer than sqrt(tau). An upper bound, for ordering vertices.
/// @param diagonal  called for the diagonal entry m + tau sum w of A at the edge's end, if it is needed
template <class Diagonal>
double heat_distance(double length, double weight, double tau, const Diagonal& diagonal) {
  const double by_length = length / std::sqrt(tau);
  if (by_length <= 3 || !(weight > 0)) return by_length;
  return std::min(by_length, std::log(diagonal() / (tau * weight)));
}

}  // namespace

March::March(const TangentGraph& graph, const HeatOptions& options, const ComponentScales& scales,
             std::vector<double> tau, Variant variant, double radius, unsigned threads, Progress progress)
    : graph_(graph),
      options_(options),
      variant_(variant),
      iterative_(graph.dimension() > 2),
      scales_(scales),
      tau_(std::move(tau)),
      // What lies ahead by x influences what lies behind by exp(-2 x).
      margin_(1.6 - 0.5 * std::log(options.accuracy)),
      step_(iterative_ ? iterative_step : default_step),
      radius_(radius),
      progress_(std::move(progress)),
      threads_(threads),
      d_(static_cast<std::size_t>(graph.dimension())),
      numbers_(graph.size()),
      ways_(1),
      known_(graph, system_of(variant)),
      found_(d_ + 1),
      nothing_(d_, NAN) {
  options_.progress = {};
  options_.threads = threads;
}

void March::run(const Source& source) { march(&source); }

void March::run_on(const AffineHeat& heat, std::size_t s) {
  std::vector<Index> reached;
  for (Index i = 0; i < graph_.size(); ++i)
    if (heat.reached(s, i)) reached.push_back(i);
  for (Index i : reached) accept(i, i, heat, s, {});
  update_front(reached);
  march(nullptr);
}

void March::march(const Source* source) {
  OneBlasThread one_thread;
  without_openmp_regions([&] {
    double depth = step_ + margin_;
    while (source || !front_.empty()) {
      progress_.step("solve", static_cast<double>(accepted_count_) / graph_.size());
      const bool advanced = advance(source, depth);
      if (advanced)
        source = nullptr;
      else
        depth *= 1.4;  // and stays so: where one band was too thin, the next ones would be
    }
  });
}

/// Solves one band and accepts its near part. Returns false when the band was too thin for anything to be accepted.
bool March::advance(const Source* source, double depth) {
  const Band band = find_band(source, depth);
  if (band.vertices.empty()) {
    front_.clear();
    return true;
  }
  ++statistics_.bands;
  statistics_.solved += static_cast<Offset>(band.vertices.size());
  statistics_.largest_band = std::max(statistics_.largest_band, static_cast<Index>(band.vertices.size()));

  // A Dirichlet neighbour behind the front adds tau w to the diagonal and (below) to the right-hand sides.
  std::vector<Link> links;
  const CsrGraph patch = cut_out(
      graph_, band.vertices, [&](Index j) { return place(j); },
      [&](std::size_t k, const Star& star, std::size_t e) {
        if (!accepted(star.neighbors[e])) return 0.0;
        links.push_back({static_cast<Index>(k), e, numbers_.find(star.neighbors[e])});
        return tau(band.vertices[k]) * star.weights[e];
      });
  std::vector<double> times;
  for (Index vertex : band.vertices) times.push_back(tau(vertex));
  const auto system = iterative_ ? iterative_system : factored_system;
  const HeatOperators operators(system(patch, std::move(times), options_), patch, {});

  HeatExponents exponents;
  Inflow inflow;
  if (source) {
    inflow = inflow_of(*source, graph_, operators, variant_);
    for (Index& vertex : inflow.vertices) vertex = place(vertex);
  } else {
    exponents = exponents_behind(links);
    inflow = inflow_behind(band, links, operators.scaling(), exponents);
  }
  for (Index vertex : band.vertices) way(vertex).place = -1;

  AffineHeat heat(patch, operators, variant_, {std::move(inflow)}, threads_);
  heat.diffuse();
  heat.solve();
  heat.solve_squares();

  const auto near = near_part(band, heat.lambda(0));
  if (!near) return false;
  std::vector<Index> added;
  for (Index k : *near) {
    added.push_back(band.vertices[k]);
    accept(added.back(), k, heat, 0, exponents);
  }
  update_front(added);
  return true;
}

/// Places in the band that are farther than the margin from all that was left out, by the heat just found there; none
/// where they are too few to be worth the band.
std::optional<std::vector<Index>> March::near_part(const Band& band, std::span<const double> lambda) const {
  auto level_of = [&](Index k) { return lambda[k] > 0 ? -std::log(lambda[k]) : INFINITY; };
  double limit = std::numeric_limits<double>::infinity();
  for (Index k : band.edge)
    if (lambda[k] > 0) limit = std::min(limit, level_of(k) - margin_);
  const double resolved = -std::log(*std::max_element(lambda.begin(), lambda.end())) + step_;
  const bool too_thin = limit < resolved;
  if (iterative_) limit = std::min(limit, resolved);
  std::vector<Index> near;
  for (std::size_t k = 0; k < band.vertices.size(); ++k)
    if (const auto place = static_cast<Index>(k); std::isinf(limit) || level_of(place) <= limit) near.push_back(place);
  if (too_thin && static_cast<double>(near.size()) * std::pow(4.0, d_) < static_cast<double>(band.vertices.size()))
    return std::nullopt;
  return near;
}

/// The vertices ahead of the front within `depth` of heat distance (Dijkstra's algorithm, the levels on the front being
/// those of the heat that was found there), in the order of the graph.
March::Band March::find_band(const Source* source, double depth) {
  Tentative tentative{*this};
  ShortestPaths<float, Tentative> paths(tentative, far_away);
  std::vector<Ahead> ahead;
  auto spread = [&](Index from, double distance) {
    const Star star = graph_.star(from);
    ahead.clear();  // a copy: the star's life may end when another one is asked for
    for (std::size_t e = 0; e < star.degree(); ++e)
      if (star.weights[e] != 0 && !accepted(star.neighbors[e]))
        ahead.push_back({star.neighbors[e], star.weights[e], length(star.log(e))});
    for (const Ahead& edge : ahead)
      paths.offer(edge.vertex, static_cast<float>(distance + heat_distance(edge.length, edge.weight, tau(edge.vertex),
                                                                           [&] { return diagonal(edge.vertex); })));
  };
  if (source) {
    for (std::size_t k = 0; k < source->vertices().size(); ++k)
      if (source->weights()[k] > 0) paths.offer(source->vertices()[k].index, 0);
  } else {
    double base = std::numeric_limits<double>::infinity();
    for (Index vertex : front_) base = std::min(base, known_.level(numbers_.find(vertex)));
    for (Index vertex : front_)
      if (const double beyond = known_.level(numbers_.find(vertex)) - base; beyond <= depth) spread(vertex, beyond);
  }

  Band band;
  std::vector<Index> touched;
  const double limit = paths.empty() ? 0 : paths.least() + depth;
  paths.run([&](Index vertex, float distance) {
    Way& own = way(vertex);
    if (own.place >= 0) return;
    if (distance > limit) return touched.push_back(vertex);
    own.place = static_cast<Index>(band.vertices.size());
    band.vertices.push_back(vertex);
    spread(vertex, distance);
  });
  for (Index vertex : touched) way(vertex).tentative = far_away;
  // The graph's own order keeps neighbours close in memory; that of the distance scatters them all around the front.
  std::sort(band.vertices.begin(), band.vertices.end());
  for (std::size_t k = 0; k < band.vertices.size(); ++k) {
    Way& own = way(band.vertices[k]);
    own.place = static_cast<Index>(k);
    own.tentative = far_away;
  }
  find_edge(band);
  return band;
}

/// The places in the band next to vertices that are neither behind the front nor in the band.
void March::find_edge(Band& band) {
  for (std::size_t k = 0; k < band.vertices.size(); ++k) {
    const Star star = graph_.star(band.vertices[k]);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index j = star.neighbors[e];
      if (star.weights[e] == 0 || accepted(j) || place(j) >= 0) continue;
      band.edge.push_back(static_cast<Index>(k));
      break;
    }
  }
}

HeatExponents March::exponents_behind(std::span<const Link> links) const {
  std::vector<Index> behind;
  for (const Link& link : links) behind.push_back(link.number);
  return known_.exponents_for(behind);
}

/// Dirichlet data: what the accepted neighbours give to the band's right-hand sides.
Inflow March::inflow_behind(const Band& band, std::span<const Link> links, double scaling,
                            HeatExponents exponents) const {
  const std::size_t width = graph_.transport_layout().width();
  Inflow in;
  for (const Link& link : links) {
    if (in.vertices.empty() || in.vertices.back() != link.place) {
      in.vertices.push_back(link.place);
      in.heat.push_back(0);
      in.frames.resize(in.frames.size() + width);
      in.values.resize(in.values.size() + d_);
      in.translations.resize(in.translations.size() + d_);
      in.squares.push_back(0);
      in.pairs.resize(in.pairs.size() + d_ * d_);
    }
    const Star star = graph_.star(band.vertices[link.place]);
    known_.add_to(in, star, link.edge, link.number, scaling * tau(band.vertices[link.place]) * star.weights[link.edge],
                  exponents);
  }
  return in;
}

void March::accept(Index vertex, Index place, const AffineHeat& heat, std::size_t s, HeatExponents exponents) {
  way(vertex).accepted = true;
  ++accepted_count_;
  const Index number = numbers_.find(vertex);
  known_.take(number, place, heat, s, exponents);
  found_.grow_to(number + 1);
  const std::span phi(found_[number], d_);
  heat.coordinates_at(s, place, phi.data());
  found_[number][d_] = heat.root_mean_square_at(s, place);
  const bool good = known_.heat(number) > 0 && heat.frames(s).heat(place) > 0 && all_finite(phi);
  if (!good) std::fill(phi.begin(), phi.end(), NAN);
}

/// The accepted vertices from which the march goes on: those with neighbours ahead, sound values, and not beyond the
/// radius.
void March::update_front(std::span<const Index> added) {
  front_.insert(front_.end(), added.begin(), added.end());
  std::erase_if(front_, [&](Index vertex) { return !sends_heat(vertex); });
}

March::Way& March::way(Index vertex) {
  const Index number = numbers_.number(vertex);
  ways_.grow_to(numbers_.count());
  return *ways_[number];
}

/// In the band at hand; -1: not in it.
Index March::place(Index vertex) const {
  const Index number = numbers_.find(vertex);
  return number < 0 ? -1 : ways_[number]->place;
}

void March::axes(Index vertex, double* out) const {
  if (accepted(vertex)) return known_.axes(numbers_.find(vertex), out);
  for (std::size_t a = 0; a < d_; ++a)
    for (std::size_t c = 0; c < d_; ++c) out[a * d_ + c] = a == c;
}

bool March::sends_heat(Index vertex) const {
  const std::span<const double> phi = coordinates(vertex);
  // A little beyond the radius, since coordinates are not monotone from vertex to vertex.
  if (!(length(phi) <= radius_ + 4 * scales_.h(vertex) * graph_.length_unit())) return false;
  const Star star = graph_.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.weights[e] != 0 && !accepted(star.neighbors[e])) return true;
  return false;
}

/// m + tau sum w: the diagonal of A.
double March::diagonal(Index vertex) const {
  double sum = graph_.mass(vertex);
  for (double w : graph_.star(vertex).weights) sum += tau(vertex) * w;
  return sum;
}

}  // namespace ahm
