#include "tile.hpp"

#include <limits>

namespace ahm::render {

bool TileDisc::set(const Layer& from, std::uint32_t point, const Lens& lens, float tile_x, float tile_y) {
  const Drawable& d = from.drawable();
  const Eigen::Vector3f view = lens.to_view(d.positions[point]);
  if (-view.z() < lens.near_plane) return false;
  layer = &from;
  const Eigen::Vector3f pixel = lens.to_pixels(view);
  x = pixel.x() - tile_x, y = pixel.y() - tile_y, nearness = pixel.z();

  Eigen::Vector3f normal = lens.axes * d.normals[point];
  normal = normal.squaredNorm() > 0 ? normal.normalized().eval() : Eigen::Vector3f::UnitZ().eval();
  if (normal.dot(view) > 0) normal = -normal;
  normal_x = normal.x(), normal_y = normal.y();
  // Limits the tilt, so that discs stay visible edge-on. i to the right, j down.
  const float steepness = 1 / std::max(normal.z(), 0.25F);
  const float rise_i = -normal.x() * steepness, rise_j = normal.y() * steepness;
  const float radius = drawn_radius(d.radii[point], nearness, lens), sample = 1 / (lens.focal * nearness);
  const float scale = sample * sample / (radius * radius);
  t_ii = scale * (1 + rise_i * rise_i), t_ij = scale * rise_i * rise_j, t_jj = scale * (1 + rise_j * rise_j);
  const float determinant = t_ii * t_jj - t_ij * t_ij;
  half_width = std::sqrt(t_jj / determinant), half_height = std::sqrt(t_ii / determinant);
  near_i = nearness * nearness * sample * rise_i, near_j = nearness * nearness * sample * rise_j;
  thickness = nearness * nearness * radius;

  const Eigen::Vector3f& v = d.values[point];
  value = {v.x(), v.y(), v.z()};
  value_i = value_j = {};
  if (!d.gradients.empty()) {
    const Eigen::Vector3f first = lens.axes * d.gradients[point][0], second = lens.axes * d.gradients[point][1];
    value_i = {sample * (first.x() + rise_i * first.z()), sample * (second.x() + rise_i * second.z())};
    value_j = {sample * (-first.y() + rise_j * first.z()), sample * (-second.y() + rise_j * second.z())};
  }
  tolerance = d.values_per_length * radius;
  if (from.material().kind == Material::Kind::pattern && from.material().pattern == Pattern::cells)
    tolerance = std::min(tolerance, 0.9F);  // the first value is the number of a color
  known = d.known[point] > 0;
  return true;
}

bool TileTriangle::set(const Layer& from, std::uint32_t triangle, float tile_x, float tile_y) {
  layer = &from;
  std::array<double, 3> x, y;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = from.drawable().triangles[3 * std::size_t{triangle} + k];
    const Eigen::Vector3f& pixel = from.pixel(corner[k]);
    x[k] = static_cast<double>(pixel.x()) - tile_x, y[k] = static_cast<double>(pixel.y()) - tile_y;
    nearness[k] = pixel.z();
  }
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (!(std::abs(area) > 1e-9)) return false;
  const double sign = area < 0 ? -1 : 1;
  double slope_x = 0, slope_y = 0, constant = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // The coefficients of two triangles at a common edge differ only in sign, so no sample falls between them.
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double p = sign * (y[i] - y[j]), q = sign * (x[j] - x[i]), r = sign * (x[i] * y[j] - x[j] * y[i]);
    a[k] = static_cast<float>(p), b[k] = static_cast<float>(q), c[k] = static_cast<float>(r);
    const double share = static_cast<double>(nearness[k]) / (sign * area);
    slope_x += p * share, slope_y += q * share, constant += r * share;
  }
  near_x = static_cast<float>(slope_x), near_y = static_cast<float>(slope_y), near_0 = static_cast<float>(constant);
  left = static_cast<float>(std::min({x[0], x[1], x[2]})), right = static_cast<float>(std::max({x[0], x[1], x[2]}));
  top = static_cast<float>(std::min({y[0], y[1], y[2]})), bottom = static_cast<float>(std::max({y[0], y[1], y[2]}));
  return true;
}

std::array<float, 3> TileTriangle::weights(float x, float y) const {
  std::array<float, 3> w;
  float sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += w[k] = (a[k] * x + b[k] * y + c[k]) * nearness[k];
  for (float& weight : w) weight /= sum;
  return w;
}

glsl::vec3 TileTriangle::value(const std::array<float, 3>& w) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += w[k] * layer->drawable().values[corner[k]];
  return {sum.x(), sum.y(), sum.z()};
}

Fragment TileTriangle::at(float x, float y, const Lens& lens) const {
  const std::array<float, 3> w = weights(x, y);
  Fragment f;
  f.value = value(w);
  const glsl::vec3 right = value(weights(x + 1, y)) - f.value, below = value(weights(x, y + 1)) - f.value;
  f.dx = {right.x, right.y}, f.dy = {below.x, below.y};
  float known = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(), place = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    known += w[k] * layer->drawable().known[corner[k]];
    normal += w[k] * layer->drawable().normals[corner[k]];
    place += w[k] * layer->drawable().positions[corner[k]];
  }
  f.known = known > 0.999F;
  if (normal.dot(place - lens.eye) > 0) normal = -normal;
  normal = lens.axes * normal;
  normal = normal.squaredNorm() > 0 ? normal.normalized().eval() : Eigen::Vector3f::UnitZ().eval();
  f.normal = {normal.x(), normal.y(), normal.z()};
  return f;
}

namespace {

using glsl::vec2;
using glsl::vec3;

/// The samples [first, last) with centers between two coordinates, clamped to the tile.
struct Range {
  int first, last;
  Range(float from, float to)
      : first(static_cast<int>(std::clamp(std::ceil(from - 0.5F), 0.0F, static_cast<float>(Tiles::side)))),
        last(static_cast<int>(std::clamp(std::floor(to + 0.5F), 0.0F, static_cast<float>(Tiles::side)))) {}
};

/// The samples of a disc in a row, j samples below its center.
Range columns_of(const TileDisc& d, float j) {
  const float middle = -d.t_ij * j / d.t_ii;
  const float half = std::sqrt(std::max(0.0F, middle * middle + (1 - d.t_jj * j * j) / d.t_ii));
  return {d.x + middle - half, d.x + middle + half};
}

}  // namespace

TileRenderer::TileRenderer(const std::vector<Layer>& layers, const Lens& lens, const Tiles& tiles)
    : layers_(layers), lens_(lens), tiles_(tiles) {}

void TileRenderer::draw(int tile, Film& film) {
  collect(tile);
  if (triangles_.empty() && discs_.empty() && transparent_.empty()) return;
  nearness_.fill(0), front_.fill(nothing), covered_.fill(false);
  for (std::size_t k = 0; k < triangles_.size(); ++k) find_nearest(triangles_[k], static_cast<std::uint32_t>(k));
  for (std::size_t k = 0; k < discs_.size(); ++k) find_nearest(discs_[k], static_cast<std::uint32_t>(k) | disc_bit);
  if (!discs_.empty()) {
    find_blocks();
    start_sums();
    for (const TileDisc& disc : discs_)
      if (!is_hidden(disc)) add(disc);
    for (int s = 0; s < samples; ++s)
      if (front_[s] != nothing && front_[s] & disc_bit && sums_.weight[s] > 0)
        nearness_[s] = sums_.nearness[s] / sums_.weight[s];
  }
  for (int y = 0; y < side; y += factor)
    for (int x = 0; x < side; x += factor) shade_pixel(x, y);
  for (const TileTriangle& triangle : transparent_) lay_over(triangle);
  develop(film);
}

void TileRenderer::collect(int tile) {
  const int column = tile % tiles_.columns, row = tile / tiles_.columns;
  left_ = static_cast<float>(column * side), top_ = static_cast<float>(row * side);
  triangles_.clear(), transparent_.clear(), discs_.clear();
  for (const Layer& layer : layers_)
    for (const std::uint32_t primitive : layer.in_tile(tile)) {
      TileTriangle triangle;
      TileDisc disc;
      if (!layer.drawable().is_mesh()) {
        if (disc.set(layer, primitive, lens_, left_, top_)) discs_.push_back(disc);
      } else if (triangle.set(layer, primitive, left_, top_)) {
        (layer.material().transparent ? transparent_ : triangles_).push_back(triangle);
      }
    }
}

void TileRenderer::find_nearest(const TileTriangle& t, std::uint32_t id) {
  const Range columns(t.left, t.right), rows(t.top, t.bottom);
  for (int row = rows.first; row < rows.last; ++row) {
    const float y = static_cast<float>(row) + 0.5F;
    const std::array<float, 3> edge{t.b[0] * y + t.c[0], t.b[1] * y + t.c[1], t.b[2] * y + t.c[2]};
    const float near_row = t.near_y * y + t.near_0;
    for (int column = columns.first; column < columns.last; ++column) {
      const float x = static_cast<float>(column) + 0.5F, near = t.near_x * x + near_row;
      const bool inside = t.a[0] * x + edge[0] >= 0 && t.a[1] * x + edge[1] >= 0 && t.a[2] * x + edge[2] >= 0;
      const int s = row * side + column;
      if (!inside || !(near > nearness_[s])) continue;
      nearness_[s] = near;
      front_[s] = id;
    }
  }
}

void TileRenderer::find_nearest(const TileDisc& disc, std::uint32_t id) {
  const TileDisc d = disc;  // a copy that cannot alias the buffers, so that the compiler vectorizes the inner loops
  const Range rows(d.y - d.half_height, d.y + d.half_height);
  const float bias = 0.3F * d.thickness;  // a slight bulge: of overlapping discs, the one with the nearest center wins
  for (int row = rows.first; row < rows.last; ++row) {
    const float j = static_cast<float>(row) + 0.5F - d.y;
    const Range columns = columns_of(d, j);
    const float t_row = d.t_jj * j * j, near_row = d.nearness + d.near_j * j, mixed = 2 * d.t_ij * j;
    float* nearness = &nearness_[row * side];
    std::uint32_t* front = &front_[row * side];
    for (int column = columns.first; column < columns.last; ++column) {
      const float i = static_cast<float>(column) + 0.5F - d.x;
      const float near = near_row + d.near_i * i - bias * ((d.t_ii * i + mixed) * i + t_row);
      const std::uint32_t wins = near > nearness[column] ? 0xffffffff : 0;
      front[column] = (front[column] & ~wins) | (id & wins);
      nearness[column] = std::max(nearness[column], near);
    }
  }
}

void TileRenderer::find_blocks() {
  block_.fill(std::numeric_limits<float>::infinity());
  for (int s = 0; s < samples; ++s) {
    float& block = block_[s / side / 8 * (side / 8) + s % side / 8];
    block = std::min(block, nearness_[s]);
  }
}

/// Whether the disc is behind all samples that it could cover.
bool TileRenderer::is_hidden(const TileDisc& d) const {
  const Range columns(d.x - d.half_width, d.x + d.half_width), rows(d.y - d.half_height, d.y + d.half_height);
  const float nearest =
      d.nearness + 2 * d.thickness + std::abs(d.near_i) * d.half_width + std::abs(d.near_j) * d.half_height;
  for (int row = rows.first / 8; 8 * row < rows.last; ++row)
    for (int column = columns.first / 8; 8 * column < columns.last; ++column)
      if (nearest > block_[row * (side / 8) + column]) return false;
  return true;
}

void TileRenderer::start_sums() {
  for (auto* sum : {&sums_.weight, &sums_.nearness, &sums_.normal_x, &sums_.normal_y, &sums_.known, &sums_.first,
                    &sums_.second, &sums_.third, &sums_.front_first, &sums_.front_second})
    sum->fill(0);
  for (int s = 0; s < samples; ++s) {
    if (front_[s] == nothing || !(front_[s] & disc_bit)) continue;
    const TileDisc& d = discs_[front_[s] & ~disc_bit];
    const vec2 middle = middle_of(s);
    const float i = middle.x - d.x, j = middle.y - d.y;
    // Discs without values are not similar to any disc.
    sums_.front_first[s] = d.known ? d.value.x + d.value_i.x * i + d.value_j.x * j : std::numeric_limits<float>::max();
    sums_.front_second[s] = d.value.y + d.value_i.y * i + d.value_j.y * j;
  }
}

void TileRenderer::add(const TileDisc& disc) {
  const TileDisc d = disc;
  const Range rows(d.y - d.half_height, d.y + d.half_height);
  const float share = d.known ? 1 : 0;
  for (int row = rows.first; row < rows.last; ++row) {
    const float j = static_cast<float>(row) + 0.5F - d.y;
    const Range columns = columns_of(d, j);
    const float t_row = d.t_jj * j * j, near_row = d.nearness + d.near_j * j, mixed = 2 * d.t_ij * j;
    const float first_row = d.value.x + d.value_j.x * j, second_row = d.value.y + d.value_j.y * j;
    for (int s = row * side + columns.first, end = row * side + columns.last; s < end; ++s) {
      const float i = static_cast<float>(s - row * side) + 0.5F - d.x;
      const float left = std::max(1 - ((d.t_ii * i + mixed) * i + t_row), 0.0F), near = near_row + d.near_i * i;
      const bool inside = std::abs(near - nearness_[s]) < d.thickness;
      const float weight = inside ? left * left + 1e-4F : 0.0F;
      const float first = first_row + d.value_i.x * i, second = second_row + d.value_i.y * i;
      const float apart = std::max(std::abs(first - sums_.front_first[s]), std::abs(second - sums_.front_second[s]));
      const float known = apart <= d.tolerance ? share * weight : 0.0F;
      sums_.weight[s] += weight;
      sums_.nearness[s] += weight * near;
      sums_.normal_x[s] += weight * d.normal_x;
      sums_.normal_y[s] += weight * d.normal_y;
      sums_.known[s] += known;
      sums_.first[s] += known * first;
      sums_.second[s] += known * second;
      sums_.third[s] += known * d.value.z;
    }
  }
}

const Material& TileRenderer::material(std::uint32_t id) const {
  return id & disc_bit ? discs_[id & ~disc_bit].layer->material() : triangles_[id].layer->material();
}

Fragment TileRenderer::fragment(int s) const {
  const TileDisc& d = discs_[front_[s] & ~disc_bit];
  Fragment f;
  f.known = d.known && sums_.known[s] > 0;
  if (f.known) {
    const float all = 1 / sums_.known[s];
    f.value = {all * sums_.first[s], all * sums_.second[s], all * sums_.third[s]};
  }
  f.dx = d.value_i, f.dy = d.value_j;
  f.normal = {d.normal_x, d.normal_y, 0};
  if (sums_.weight[s] > 0) f.normal = vec3(sums_.normal_x[s], sums_.normal_y[s], 0) * (1 / sums_.weight[s]);
  f.normal.z = std::sqrt(std::max(0.0F, 1 - glsl::dot(f.normal, f.normal)));
  return f;
}

/// The color of a single sample.
vec3 TileRenderer::light(int s, vec2 pixel) const {
  const std::uint32_t id = front_[s];
  const auto [x, y] = middle_of(s);
  Fragment f = id & disc_bit ? fragment(s) : triangles_[id].at(x, y, lens_);
  f.dx = f.dx * factor, f.dy = f.dy * factor;
  f.pixel = pixel;
  return shade(material(id), f);
}

/// Shades the samples of a pixel; only once if all of them show the same primitive.
void TileRenderer::shade_pixel(int x, int y) {
  const std::array<int, 4> s{y * side + x, y * side + x + 1, (y + 1) * side + x, (y + 1) * side + x + 1};
  const vec2 pixel((left_ + static_cast<float>(x)) / factor, (top_ + static_cast<float>(y)) / factor);
  const bool whole = std::all_of(s.begin(), s.end(), [&](int k) { return front_[k] == front_[s[0]]; });
  if (whole && front_[s[0]] == nothing) return;
  if (whole && material(front_[s[0]]).kind != Material::Kind::texture) {
    const std::uint32_t id = front_[s[0]];
    Fragment f =
        id & disc_bit ? fragment(s[0]) : triangles_[id].at(static_cast<float>(x) + 1, static_cast<float>(y) + 1, lens_);
    if (id & disc_bit) {
      const Fragment last = fragment(s[3]);
      f.value = (f.value + last.value) * 0.5F;
      f.known = f.known && last.known;
      f.normal = glsl::normalize(f.normal + last.normal);
    }
    f.dx = f.dx * factor, f.dy = f.dy * factor;
    f.pixel = pixel;
    const vec3 all = shade(material(id), f);
    for (const int k : s) light_[k] = all, covered_[k] = true;
    return;
  }
  for (const int k : s) {
    if (front_[k] == nothing) continue;
    light_[k] = light(k, pixel);
    covered_[k] = true;
  }
}

void TileRenderer::lay_over(const TileTriangle& t) {
  const Range columns(t.left, t.right), rows(t.top, t.bottom);
  for (int row = rows.first; row < rows.last; ++row)
    for (int column = columns.first; column < columns.last; ++column) {
      const float x = static_cast<float>(column) + 0.5F, y = static_cast<float>(row) + 0.5F;
      const int s = row * side + column;
      bool inside = t.near_x * x + t.near_y * y + t.near_0 > nearness_[s];
      for (std::size_t k = 0; k < 3; ++k) inside = inside && t.a[k] * x + t.b[k] * y + t.c[k] >= 0;
      if (!inside) continue;
      Fragment f = t.at(x, y, lens_);
      const vec3 color = shade(t.layer->material(), f);
      if (!covered_[s]) light_[s] = vec3(1), covered_[s] = true;
      light_[s] = glsl::mix(light_[s], color, f.opacity);
    }
}

void TileRenderer::develop(Film& film) const {
  const int left = static_cast<int>(left_) / factor, top = static_cast<int>(top_) / factor;
  for (int y = 0; y < side / factor && top + y < film.height; ++y)
    for (int x = 0; x < side / factor && left + x < film.width; ++x) {
      Pixel pixel;
      vec3 sum;
      int covered = 0;
      for (int k = 0; k < factor * factor; ++k) {
        const int s = (y * factor + k / factor) * side + x * factor + k % factor;
        if (!covered_[s]) continue;
        sum = sum + light_[s];
        ++covered;
        pixel.nearness = std::max(pixel.nearness, nearness_[s]);
      }
      constexpr float share = 65535.0F / (factor * factor);
      pixel.coverage = static_cast<std::uint16_t>(std::lround(share * static_cast<float>(covered)));
      for (const auto& [c, channel] : {std::pair{0, sum.x}, std::pair{1, sum.y}, std::pair{2, sum.z}})
        pixel.light[c] = std::min(pixel.coverage, static_cast<std::uint16_t>(std::lround(share * channel)));
      film.at(left + x, top + y) = pixel;
    }
}

}  // namespace ahm::render
