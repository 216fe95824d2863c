/// \file
/// What a backend found and did, as data. Programs word it; libraries only name it.
///
/// \code
/// for (const ahm::Figure& figure : surface.report()) std::cout << figure.id << '\n';      // "flips", "seconds.graph"
/// for (const ahm::Warning& warning : surface.warnings())
///   if (warning.id == "mollified") std::cout << warning.numbers[0] << '\n';
/// \endcode
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ahm/types.hpp"

namespace ahm {

/// One entry of a report.
struct Figure {
  std::string_view id;  ///< snake_case, static storage; "group.name" for what belongs together
  std::variant<bool, std::int64_t, double, std::string_view> value;
};

/// In the order in which it is to be read.
using Report = std::vector<Figure>;

/// Something the user should know, that was no reason to refuse the input. Each backend's header lists its ids and what
/// their numbers and rows mean.
struct Warning {
  std::string_view id;          ///< snake_case, static storage
  std::vector<double> numbers;  ///< counts and lengths (world units), as the id says
  std::vector<Row> rows;        ///< the first ten rows concerned, where the id names rows
  std::string name{};           ///< of a thing that is called by its name in the input, where the id says so
};

}  // namespace ahm
