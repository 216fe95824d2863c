/// \file
/// Lines, words and numbers of text files. Parsing is strict and independent of the locale.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read/bytes.hpp"
#include "read/input.hpp"
#include "read/skipped_lines.hpp"

namespace ahm::io {

/// Reads a text line by line. Lines end with "\n", "\r\n", or, in a text without any "\n", with "\r".
class Lines {
 public:
  explicit Lines(std::string_view text, std::int64_t first_number = 1);
  /// Reads lines of a file from the byte `begin` on, block by block. Do not move this object after reading the first line.
  Lines(const ByteStream& file, std::uint64_t begin, std::int64_t first_number = 1);

  /// Moves to the next line; false at the end.
  bool next();
  /// Moves to the next line that contains a word, and cuts off its comment.
  /// @param comment  character at the beginning of a word that starts a comment; nullopt: no comments
  bool next_filled(std::optional<char> comment = {});
  /// Moves to the next line of data: as `next_filled`, but skips comments of unknown dialects, too (`is_remark`).
  bool next_data(std::optional<char> comment = {});

  /// The current line without its end; valid until the next line is read.
  std::string_view line() const noexcept { return line_; }
  /// 1-based number of the current line.
  std::int64_t number() const noexcept { return number_; }
  /// Position in the text after the current line and its end.
  std::size_t position() const noexcept { return position_; }
  /// Lines that `next_data` skipped as unknown; readers add others.
  SkippedLines& skipped() noexcept { return skipped_; }

 private:
  bool read_on();

  std::unique_ptr<ByteStream> file_;  ///< null: `text_` is the whole text
  std::string buffer_;                ///< current block of the file
  std::string_view text_;
  std::string_view line_;
  std::size_t position_ = 0;
  std::int64_t number_;
  char end_ = '\n';
  SkippedLines skipped_;
};

/// The line without its comment, which begins with `comment` at the beginning of a word.
std::string_view without_comment(std::string_view line, char comment) noexcept;
/// Removes the next word from the front of `rest` and returns it; empty at the end. Blanks and tabs separate words.
std::string_view next_word(std::string_view& rest) noexcept;
/// Splits a line into words. Reuses the memory of `words`.
void split_words(std::string_view line, std::vector<std::string_view>& words);
/// The text without a byte order mark at its beginning.
std::string_view without_byte_order_mark(std::string_view text) noexcept;
/// Whether the word equals `lower` (in lower case), ignoring case.
bool equals_ignoring_case(std::string_view word, std::string_view lower) noexcept;

/// The word as a number; nullopt if it is not a number ("1,5", "1.#IND") or exceeds the range of double precision ("1e400").
/// "nan", "inf" and "infinity" are numbers. Numbers too small for a double become zero.
std::optional<double> to_real(std::string_view word) noexcept;
/// The word as a whole number; nullopt if it is not a whole number or is out of range.
std::optional<std::int64_t> to_whole(std::string_view word) noexcept;

/// Whether the word is a number, possibly with a decimal comma.
bool is_like_number(std::string_view word);

/// As `to_real`. @throws IoError with the line and the word
double real_or_fail(const Input& in, std::int64_t line, std::string_view word);
/// As `to_whole`. @throws IoError with the line and the word
std::int64_t whole_or_fail(const Input& in, std::int64_t line, std::string_view word);

}  // namespace ahm::io
