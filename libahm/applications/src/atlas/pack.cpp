// The only file that includes stb_rect_pack.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "ahm/applications/atlas.hpp"
#include "ahm/util/small_math.hpp"
#include "ahm/util/text.hpp"

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_rect_pack.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace ahm {
namespace {

double side(const ChartBox& box, std::size_t axis) { return box.high[axis] - box.low[axis]; }

/// The box of the same chart after a quarter turn: x' = y, y' = -x.
ChartBox quarter_turned(const ChartBox& box) {
  return {{-box.turn[1], box.turn[0]}, {box.low[1], -box.high[0]}, {box.high[1], -box.low[0]}};
}

/// Positions of the boxes in the square at this scale, in the same order; empty if they do not fit.
std::optional<std::vector<TextureBox>> place(const std::vector<ChartBox>& boxes, double scale, int size, int margin) {
  std::vector<stbrp_rect> rectangles;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    std::array<double, 2> texels;
    for (std::size_t c : {0, 1}) {
      texels[c] = std::max(1.0, std::ceil(scale * side(boxes[k], c))) + margin;
      if (!(texels[c] <= size - margin)) return std::nullopt;
    }
    rectangles.push_back({static_cast<int>(k), static_cast<int>(texels[0]), static_cast<int>(texels[1]), 0, 0, 0});
  }
  // Each rectangle includes its margin on the right and above; the offset of the square adds the others.
  const int room = size - margin;
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(room));
  stbrp_context context;
  stbrp_init_target(&context, room, room, nodes.data(), room);
  stbrp_setup_heuristic(&context, STBRP_HEURISTIC_Skyline_BF_sortHeight);
  if (stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size())) == 0) return std::nullopt;
  std::vector<TextureBox> result;
  for (const stbrp_rect& r : rectangles) result.push_back({r.x + margin, r.y + margin, r.w - margin, r.h - margin});
  return result;
}

/// The largest scale at which all boxes fit, to 1 %.
double largest_scale(const std::vector<ChartBox>& boxes, const PackOptions& options) {
  double size = 0, area = 0;
  for (const ChartBox& box : boxes) size = std::max({size, side(box, 0), side(box, 1)});
  const double unit = power_of_two_below(size);
  for (const ChartBox& box : boxes) area += side(box, 0) / unit * (side(box, 1) / unit);
  double high = area > 0 ? options.size / std::sqrt(area) / unit : 1, low = 0;
  for (double scale = high; low == 0 && scale > 1e-4 * high; scale /= 2)
    if (place(boxes, scale, options.size, options.margin)) low = scale;
  if (low == 0)
    throw InvalidArgument("the charts (" + std::to_string(boxes.size()) + ") with margins of " +
                          detail::counted(options.margin, "texel") + " do not fit into a texture of " +
                          std::to_string(options.size) + "; enlarge size, or lower margin or the number of charts");
  high = std::min(high, 2 * low);
  while (high > 1.01 * low) {
    const double middle = (low + high) / 2;
    (place(boxes, middle, options.size, options.margin) ? low : high) = middle;
  }
  return low;
}

}  // namespace

bool can_pack() noexcept { return true; }

TextureAtlas pack(const Atlas& atlas, const FaceList& faces, const PackOptions& options) {
  if (options.size < 16 || options.size > 32768)
    throw InvalidArgument("size is " + std::to_string(options.size) + "; it must be 16 to 32768");
  if (options.margin < 0) throw InvalidArgument("margin is " + std::to_string(options.margin) + "; it must be >= 0");
  std::vector<ChartBox> boxes = chart_boxes(atlas, faces);
  TextureAtlas result;
  result.size = options.size;
  result.margin = options.margin;
  result.coordinates.assign(atlas.coordinates.size(), std::numeric_limits<double>::quiet_NaN());
  if (boxes.empty()) return result;
  result.scale = largest_scale(boxes, options);
  std::vector<ChartBox> upright;
  std::transform(boxes.begin(), boxes.end(), std::back_inserter(upright), quarter_turned);
  if (const double scale = largest_scale(upright, options); scale > result.scale) {
    result.scale = scale;
    boxes.swap(upright);
  }
  result.boxes = *place(boxes, result.scale, options.size, options.margin);
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const TextureBox& target = result.boxes[k];
    const double origin[] = {static_cast<double>(target.x), static_cast<double>(target.y)};
    const auto [c, s] = boxes[k].turn;
    result.filled += static_cast<double>(target.width) * target.height;
    for (Index f : atlas.charts[k].faces)
      for (Offset corner = faces.begin[f]; corner < faces.begin[Offset{f} + 1]; ++corner) {
        const auto [u, v] = atlas.corner(corner);
        const double turned[] = {c * u + s * v, c * v - s * u};
        for (std::size_t a : {0, 1})
          result.coordinates[2 * corner + static_cast<Offset>(a)] =
              (origin[a] + result.scale * (turned[a] - boxes[k].low[a])) / options.size;
      }
  }
  result.filled /= static_cast<double>(options.size) * options.size;
  return result;
}

}  // namespace ahm
