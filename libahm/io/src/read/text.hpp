/// \file
/// Lines, words and numbers of text files: strict, and the same in every locale.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read/bytes.hpp"
#include "read/input.hpp"

namespace ahm::io {

/// Walks a text line by line. Lines end with "\n", "\r\n", or, in a text without any "\n", with "\r".
class Lines {
 public:
  explicit Lines(std::string_view text, std::int64_t first_number = 1);
  /// Of a file from this byte on, of which some is in memory at a time; not to be moved once the first line is read.
  Lines(const ByteStream& file, std::uint64_t begin, std::int64_t first_number = 1);

  /// Moves to the next line; false at the end.
  bool next();
  /// Moves to the next line that holds a word before any `comment` sign (at the front of a word), if there is such a sign; `line` is
  /// then without it.
  bool next_filled(std::optional<char> comment = {});

  /// Without the line end; valid until the next.
  std::string_view line() const noexcept { return line_; }
  /// 1-based number of the current line.
  std::int64_t number() const noexcept { return number_; }
  /// Position in the text behind the current line and its end.
  std::size_t position() const noexcept { return position_; }

 private:
  bool read_on();

  std::unique_ptr<ByteStream> file_;  ///< null: `text_` is all there is
  std::string buffer_;                ///< of it
  std::string_view text_;
  std::string_view line_;
  std::size_t position_ = 0;
  std::int64_t number_;
  char end_ = '\n';
};

/// Takes the next word off the front of `rest`; empty at the end. Words are separated by blanks and tabs.
std::string_view next_word(std::string_view& rest) noexcept;
/// All words of a line, in a vector that is reused from line to line.
void split_words(std::string_view line, std::vector<std::string_view>& words);
/// The text without a byte order mark at its front.
std::string_view without_byte_order_mark(std::string_view text) noexcept;
/// True when the word equals `lower` (lower case), whatever its case.
bool equals_ignoring_case(std::string_view word, std::string_view lower) noexcept;

/// The whole word as a number, nullopt when it is none ("1,5", "1.#IND") or beyond double precision's range ("1e400").
/// "nan", "inf" and "infinity" are numbers; what is too small for a double is zero.
std::optional<double> to_real(std::string_view word) noexcept;
/// The whole word as a whole number, nullopt when it is none or does not fit.
std::optional<std::int64_t> to_whole(std::string_view word) noexcept;

/// Whether the word is a number, or would be one with a point in place of a comma.
bool is_like_number(std::string_view word);

/// As `to_real`. @throws IoError with the line and the word
double real_or_fail(const Input& in, std::int64_t line, std::string_view word);
/// As `to_whole`. @throws IoError with the line and the word
std::int64_t whole_or_fail(const Input& in, std::int64_t line, std::string_view word);

}  // namespace ahm::io
