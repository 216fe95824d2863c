/// \file
/// Statistics and warnings of a backend, as data. The libraries only set ids and numbers; programs turn them into text.
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
  std::string_view id;  ///< snake_case, static storage; "group.name" for entries of a group
  std::variant<bool, std::int64_t, double, std::string_view> value;
};

/// The entries of a report, in display order.
using Report = std::vector<Figure>;

/// A problem of the input that is not an error. The header of each backend lists its ids and the meaning of their numbers and rows.
struct Warning {
  std::string_view id;          ///< snake_case, static storage
  std::vector<double> numbers;  ///< counts and lengths (world units); their meaning depends on the id
  std::vector<Row> rows;        ///< the first ten affected rows, if the id has rows
  std::string name{};           ///< name of an object of the input, if the id has one
};

}  // namespace ahm
