#include "cli/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ahm::app {
namespace {

[[noreturn]] void refuse(std::string_view text, std::string_view expected) {
  throw std::invalid_argument(fmt::format("'{}' is not {}", text, expected));
}

std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

}  // namespace

double parse_number(std::string_view text) {
  const std::string_view digits = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) refuse(text, "a number that fits double precision");
  if (error != std::errc{} || end != digits.data() + digits.size()) refuse(text, "a number");
  if (!std::isfinite(value)) refuse(text, "a finite number");
  return value;
}

double parse_positive(std::string_view text) {
  const double value = parse_number(text);
  if (!(value > 0)) refuse(text, "a number > 0");
  return value;
}

double parse_degrees(std::string_view text) { return parse_number(text) * std::numbers::pi / 180; }

std::int64_t parse_integer(std::string_view text, std::int64_t low, std::int64_t high) {
  const std::string_view digits = without_plus(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::invalid_argument || !whole) refuse(text, "a whole number");
  if (error != std::errc{} || value < low || value > high)
    refuse(text, high == std::numeric_limits<Index>::max() ? fmt::format("a whole number >= {}", low)
                                                           : fmt::format("a whole number from {} to {}", low, high));
  return value;
}

std::vector<double> parse_numbers(std::string_view text) {
  std::vector<double> result;
  for (std::string_view rest = text;;) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    result.push_back(parse_number(rest.substr(0, comma)));
    if (comma == rest.size()) return result;
    rest.remove_prefix(comma + 1);
  }
}

Vec3 parse_triple(std::string_view text) {
  if (std::count(text.begin(), text.end(), ',') != 2) refuse(text, "three numbers separated by commas");
  const std::vector<double> numbers = parse_numbers(text);
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3 parse_direction(std::string_view text) {
  const Vec3 v = parse_triple(text);
  if (v == Vec3{0, 0, 0}) refuse(text, "a direction: it is zero");
  return v;
}

}  // namespace ahm::app
