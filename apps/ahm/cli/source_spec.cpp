#include "cli/source_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "cli/numbers.hpp"

namespace ahm::app {
namespace {

SourceFace parse_face(std::string_view text) {
  const std::string_view rest = text.substr(5);
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos)
    throw std::invalid_argument(fmt::format("'{}' lacks barycentric coordinates: write face:F:b0,b1,b2", text));
  SourceFace result{static_cast<Index>(parse_integer(rest.substr(0, colon), 0)), parse_numbers(rest.substr(colon + 1))};
  const auto& weights = result.weights;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (weights.size() < 3)
    throw std::invalid_argument(
        fmt::format("'{}' has {} barycentric coordinates; write one per corner of the face", text, weights.size()));
  if (*std::min_element(weights.begin(), weights.end()) < 0 || std::abs(sum - 1) > 1e-6)
    throw std::invalid_argument(fmt::format(
        "'{}' has barycentric coordinates that are negative or do not add up to 1 (they add up to {})", text, sum));
  return result;
}

}  // namespace

SourceSpec parse_source(std::string_view text) {
  if (text.starts_with("face:")) return parse_face(text);
  if (text.find(',') != std::string_view::npos) return SourcePosition{parse_triple(text)};
  try {
    return SourceVertex{static_cast<Index>(parse_integer(text, 0))};
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        fmt::format("'{}' is no source: write a 0-based vertex index, x,y,z or face:F:b0,b1,b2", text));
  }
}

std::string to_string(const SourceSpec& spec) {
  struct Visitor {
    std::string operator()(const SourceVertex& s) const { return fmt::format("{}", s.index); }
    std::string operator()(const SourcePosition& s) const {
      return fmt::format("{},{},{}", s.position[0], s.position[1], s.position[2]);
    }
    std::string operator()(const SourceFace& s) const {
      return fmt::format("face:{}:{}", s.face, fmt::join(s.weights, ","));
    }
  };
  return std::visit(Visitor{}, spec);
}

}  // namespace ahm::app
