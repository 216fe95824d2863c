#include "maps/march.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "graph/patch.hpp"
#include "heat/blas_control.hpp"

namespace ahm {
namespace {

/// Heat distance accepted per band, where the front is as regular as the graph's edges. Measured: deeper bands cost more
/// fill per vertex, thinner ones solve each vertex more often.
constexpr double default_step = 24;

/// The same where bands are solved iteratively: the cost of a vertex does not grow with the band's depth, but what has
/// decayed further loses digits.
constexpr double iterative_step = 8;

constexpr float far_away = std::numeric_limits<float>::infinity();

}  // namespace

March::March(const TangentGraph& graph, const OperatorOptions& operators, Variant variant, double accuracy,
             double radius, unsigned threads, Progress progress)
    : graph_(graph),
      options_(operators),
      variant_(variant),
      iterative_(graph.dimension() > 2),
      // What lies ahead by x influences what lies behind by exp(-2 x).
      margin_(1.6 - 0.5 * std::log(accuracy)),
      step_(iterative_ ? iterative_step : default_step),
      // A little beyond, since coordinates are not monotone from vertex to vertex.
      radius_(radius + 4 * graph.mean_edge_length() * graph.length_unit()),
      tau_(operators.t_coef * graph.mean_edge_length() * graph.mean_edge_length()),
      progress_(std::move(progress)),
      threads_(threads),
      d_(static_cast<std::size_t>(graph.dimension())),
      width_(FrameField(graph.size(), graph.dimension(), graph.transport_kind()).width()) {
  options_.check_graph = false;
  options_.progress = {};
  options_.threads = threads;
  const auto n = static_cast<std::size_t>(graph.size());
  accepted_.assign(n, 0);
  place_.assign(n, -1);
  tentative_.assign(n, far_away);
  at_.lambda.resize(n);
  at_.solution.resize(n * d_);
  at_.frame.resize(n * width_);
  at_.heat_exponent.resize(n);
  at_.frame_exponent.resize(n);
  coordinates_.assign(n * d_, NAN);
}

void March::run(const Source& source) { march(&source); }

void March::run_on(const AffineHeat& heat, std::size_t s, std::span<const double> solution) {
  std::vector<Index> reached;
  for (Index i = 0; i < graph_.size(); ++i)
    if (heat.reached(s, i)) reached.push_back(i);
  for (Index i : reached) accept(i, i, heat, s, solution, 0, 0);
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
      graph_, band.vertices, [&](Index j) { return place_[j]; },
      [&](std::size_t k, const Star& star, std::size_t e) {
        if (!accepted_[star.neighbors[e]]) return 0.0;
        links.push_back({static_cast<Index>(k), e});
        return tau_ * star.weights[e];
      });
  const HeatOperators operators(patch, options_, iterative_);

  std::int32_t heat_exponent = 0, frame_exponent = 0;
  Inflow inflow;
  if (source) {
    inflow = inflow_of(*source, graph_, operators);
    for (Index& vertex : inflow.vertices) vertex = place_[vertex];
  } else {
    inflow = inflow_behind(band, links, operators.scaling(), heat_exponent, frame_exponent);
  }
  for (Index vertex : band.vertices) place_[vertex] = -1;

  AffineHeat heat(patch, operators, {std::move(inflow)}, threads_);
  heat.diffuse();
  const std::vector<double> solution = heat.solve(variant_);

  // Accept what is farther than the margin from all that was left out, by the heat just found.
  const auto lambda = heat.lambda(0);
  auto level_of = [&](Index k) { return lambda[k] > 0 ? -std::log(lambda[k]) : INFINITY; };
  double limit = std::numeric_limits<double>::infinity();
  for (Index k : band.edge)
    if (lambda[k] > 0) limit = std::min(limit, level_of(k) - margin_);
  const double resolved = -std::log(*std::max_element(lambda.begin(), lambda.end())) + step_;
  const bool too_thin = limit < resolved;
  if (iterative_) limit = std::min(limit, resolved);
  std::vector<Index> near, added;
  for (std::size_t k = 0; k < band.vertices.size(); ++k)
    if (const auto place = static_cast<Index>(k); std::isinf(limit) || level_of(place) <= limit) near.push_back(place);
  if (too_thin && static_cast<double>(near.size()) * std::pow(4.0, d_) < static_cast<double>(band.vertices.size()))
    return false;
  for (Index k : near) {
    added.push_back(band.vertices[k]);
    accept(added.back(), k, heat, 0, solution, heat_exponent, frame_exponent);
  }
  update_front(added);
  return true;
}

/// The vertices ahead of the front within `depth` of heat distance (Dijkstra's algorithm, the levels on the front being
/// those of the heat that was found there), in the order of the graph.
March::Band March::find_band(const Source* source, double depth) {
  using Entry = std::pair<float, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  auto offer = [&](Index vertex, double distance) {
    float& known = tentative_[vertex];
    if (static_cast<float>(distance) < known) queue.push({known = static_cast<float>(distance), vertex});
  };
  auto spread = [&](Index from, double distance) {
    Star star = graph_.star(from);
    auto diagonal_at = [&](Index vertex) {
      const double a = diagonal(vertex);
      star = graph_.star(from);  // the call above may have ended its life
      return a;
    };
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const Index to = star.neighbors[e];
      if (star.weights[e] == 0 || accepted_[to]) continue;
      offer(to, distance + heat_distance(star, e, tau_, [&] { return diagonal_at(to); }));
    }
  };
  if (source) {
    for (std::size_t k = 0; k < source->vertices().size(); ++k)
      if (source->weights()[k] > 0) offer(source->vertices()[k].index, 0);
  } else {
    double base = std::numeric_limits<double>::infinity();
    for (Index vertex : front_) base = std::min(base, level(vertex));
    for (Index vertex : front_)
      if (const double ahead = level(vertex) - base; ahead <= depth) spread(vertex, ahead);
  }

  Band band;
  std::vector<Index> touched;
  const double limit = queue.empty() ? 0 : queue.top().first + depth;
  while (!queue.empty()) {
    const auto [distance, vertex] = queue.top();
    queue.pop();
    Index& place = place_[vertex];
    if (place >= 0) continue;
    if (distance > limit) {
      touched.push_back(vertex);
      continue;
    }
    place = static_cast<Index>(band.vertices.size());
    band.vertices.push_back(vertex);
    spread(vertex, distance);
  }
  for (Index vertex : touched) tentative_[vertex] = far_away;
  // The graph's own order keeps neighbours close in memory; that of the distance scatters them all around the front.
  std::sort(band.vertices.begin(), band.vertices.end());
  for (std::size_t k = 0; k < band.vertices.size(); ++k) place_[band.vertices[k]] = static_cast<Index>(k);
  for (std::size_t k = 0; k < band.vertices.size(); ++k) {
    tentative_[band.vertices[k]] = far_away;
    const Star star = graph_.star(band.vertices[k]);
    for (std::size_t e = 0; e < star.degree(); ++e) {
      const auto j = static_cast<std::size_t>(star.neighbors[e]);
      if (star.weights[e] == 0 || accepted_[j] || place_[j] >= 0) continue;
      band.edge.push_back(static_cast<Index>(k));
      break;
    }
  }
  return band;
}

/// Dirichlet data: for an accepted neighbour j of i, A gives tau w_ij lambda_j to the right-hand side of i, B gives
/// tau w_ij R_ji U~_j, and so on for the other two systems.
Inflow March::inflow_behind(const Band& band, std::span<const Link> links, double scaling, std::int32_t& heat_exponent,
                            std::int32_t& frame_exponent) const {
  // Scale the largest accepted value to `heat_scale`.
  heat_exponent = frame_exponent = std::numeric_limits<std::int32_t>::min();
  auto neighbor = [&](const Link& link) {
    return static_cast<std::size_t>(graph_.star(band.vertices[link.place]).neighbors[link.edge]);
  };
  for (const Link& link : links) {
    const std::size_t j = neighbor(link);
    if (at_.lambda[j] != 0) heat_exponent = std::max(heat_exponent, at_.heat_exponent[j] + std::ilogb(at_.lambda[j]));
    for (std::size_t a = 0; a < width_; ++a)
      if (const double u = at_.frame[j * width_ + a]; u != 0)
        frame_exponent = std::max(frame_exponent, at_.frame_exponent[j] + std::ilogb(u));
  }
  heat_exponent -= std::ilogb(heat_scale);
  frame_exponent -= std::ilogb(heat_scale);

  const bool is_complex = graph_.transport_kind() == TransportKind::rotation2;
  const double to_units = graph_.length_unit() / solution_unit(graph_);
  Inflow in;
  for (const Link& link : links) {
    if (in.vertices.empty() || in.vertices.back() != link.place) {
      in.vertices.push_back(link.place);
      in.heat.push_back(0);
      in.frames.resize(in.frames.size() + width_);
      in.coordinates.resize(in.coordinates.size() + d_);
      in.vectors.resize(in.vectors.size() + d_);
      in.translations.resize(in.translations.size() + d_);
    }
    const Star star = graph_.star(band.vertices[link.place]);
    const auto j = static_cast<std::size_t>(star.neighbors[link.edge]);
    const double conductance = scaling * tau_ * star.weights[link.edge];
    const double heat = std::ldexp(conductance, at_.heat_exponent[j] - heat_exponent);
    const double turn = std::ldexp(conductance, at_.frame_exponent[j] - frame_exponent);
    in.heat.back() += heat * at_.lambda[j];
    const double *x = at_.solution.data() + j * d_, *u = at_.frame.data() + j * width_;
    double *coordinates = in.coordinates.data() + in.coordinates.size() - d_,
           *vectors = in.vectors.data() + in.vectors.size() - d_,
           *frames = in.frames.data() + in.frames.size() - width_,
           *translations = in.translations.data() + in.translations.size() - d_;
    for (std::size_t a = 0; a < d_; ++a) {
      coordinates[a] += heat * x[a];
      translations[a] -= heat * at_.lambda[j] * (to_units * star.logs[link.edge * d_ + a]);
    }
    if (is_complex) {
      const double* R = star.transports.data() + link.edge * 2;
      frames[0] += turn * (R[0] * u[0] - R[1] * u[1]);
      frames[1] += turn * (R[0] * u[1] + R[1] * u[0]);
      vectors[0] += heat * (R[0] * x[0] - R[1] * x[1]);
      vectors[1] += heat * (R[0] * x[1] + R[1] * x[0]);
      continue;
    }
    const double* R = star.transports.data() + link.edge * d_ * d_;
    for (std::size_t c = 0; c < d_; ++c)
      for (std::size_t b = 0; b < d_; ++b) {
        vectors[c] += heat * R[c * d_ + b] * x[b];
        for (std::size_t a = 0; a < d_; ++a) frames[c * d_ + a] += turn * R[c * d_ + b] * u[b * d_ + a];
      }
  }
  return in;
}

void March::accept(Index vertex, Index place, const AffineHeat& heat, std::size_t s, std::span<const double> solution,
                   std::int32_t heat_exponent, std::int32_t frame_exponent) {
  const auto i = static_cast<std::size_t>(vertex);
  accepted_[i] = 1;
  ++accepted_count_;
  at_.lambda[i] = heat.lambda(s)[place];
  heat.solution_at(variant_, solution, place, at_.solution.data() + i * d_);
  heat.frames(s).raw(place, at_.frame.data() + i * width_);
  at_.heat_exponent[i] = heat_exponent;
  at_.frame_exponent[i] = frame_exponent;
  const std::span phi = std::span(coordinates_).subspan(i * d_, d_);
  heat.coordinates_at(variant_, s, solution, place, phi.data());
  const bool good = at_.lambda[i] > 0 && heat.frames(s).heat(place) > 0 && all_finite(phi);
  if (!good) std::fill(phi.begin(), phi.end(), NAN);
}

/// The accepted vertices from which the march goes on: those with neighbours ahead, sound values, and not beyond the
/// radius.
void March::update_front(std::span<const Index> added) {
  front_.insert(front_.end(), added.begin(), added.end());
  std::erase_if(front_, [&](Index vertex) { return !sends_heat(vertex); });
}

bool March::sends_heat(Index vertex) const {
  const auto phi = std::span(coordinates_).subspan(static_cast<std::size_t>(vertex) * d_, d_);
  if (!(length(phi) <= radius_)) return false;
  const Star star = graph_.star(vertex);
  for (std::size_t e = 0; e < star.degree(); ++e)
    if (star.weights[e] != 0 && !accepted_[star.neighbors[e]]) return true;
  return false;
}

/// -log lambda
double March::level(Index vertex) const {
  const auto i = static_cast<std::size_t>(vertex);
  return -std::log(at_.lambda[i]) - std::log(2.0) * at_.heat_exponent[i];
}

void March::axes(Index vertex, double* out) const {
  // One vertex is a field of its own; in block graphs its columns are then the rows of the transposed matrix.
  std::vector<double> U(
      at_.frame.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(vertex) * width_),
      at_.frame.begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(vertex) + 1) * width_));
  if (graph_.transport_kind() == TransportKind::block)
    for (std::size_t a = 0; a < d_; ++a)
      for (std::size_t c = 0; c < a; ++c) std::swap(U[a * d_ + c], U[c * d_ + a]);
  FrameField(1, graph_.dimension(), graph_.transport_kind(), U).axes(0, out);
}

/// m + tau sum w: the diagonal of A.
double March::diagonal(Index vertex) const {
  double sum = graph_.mass(vertex);
  for (double w : graph_.star(vertex).weights) sum += tau_ * w;
  return sum;
}

}  // namespace ahm
