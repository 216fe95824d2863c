/// \file
/// Lines of text files that a reader neither understands nor needs. Every text reader has the same rule: such lines do not stop it,
/// and one warning reports them; damaged lines that it needs are errors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/report.hpp"

namespace ahm::io {

/// Whether a line is a comment of an unknown dialect: it begins with a punctuation mark that begins no number, name or list
/// (# $ % & * / : ; < = > ? @ \ ^ ` | ~ !), and contains no control characters.
bool is_remark(std::string_view line) noexcept;
/// Whether the text contains control characters other than tabs and line ends: it is binary or damaged.
bool has_control_characters(std::string_view text) noexcept;

class SkippedLines {
 public:
  /// @param number  1-based number of the line
  void add(std::int64_t number, std::string_view line);
  bool empty() const noexcept { return count_ == 0; }
  /// Adds the warning "lines_skipped", unless there are no such lines.
  void report(std::vector<Warning>& warnings) const;
  /// For errors about missing data: "; not understood: 3 lines, the first is line 1: 'title'". Empty if there are no such lines.
  std::string hint() const;

 private:
  std::int64_t count_ = 0, first_ = 0;
  std::string text_;  ///< the first line, in quotes
};

}  // namespace ahm::io
