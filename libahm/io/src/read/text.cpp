#include "read/text.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "ahm/util/from_chars.hpp"

namespace ahm::io {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;  // bytes read from a file at a time

constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Removes a leading plus sign, which from_chars does not accept.
std::string_view without_plus(std::string_view word) noexcept {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return plus ? word.substr(1) : word;
}

/// Whether a number is out of range because it is too small: a short mantissa with a negative exponent.
bool is_underflow(std::string_view word) noexcept {
  const std::size_t exponent = word.find_first_of("eE");
  return exponent < 64 && word.substr(exponent + 1).starts_with('-');
}

/// The word with its first comma replaced by a point.
std::string with_point(std::string_view word) {
  std::string result(word);
  if (const std::size_t comma = result.find(','); comma != std::string::npos) result[comma] = '.';
  return result;
}

}  // namespace

Lines::Lines(std::string_view text, std::int64_t first_number) : text_(text), number_(first_number - 1) {
  if (text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos) end_ = '\r';
}

Lines::Lines(const ByteStream& file, std::uint64_t begin, std::int64_t first_number)
    : file_(std::make_unique<ByteStream>(file, begin)), number_(first_number - 1) {
  ByteStream ahead(file, begin);
  std::string block(block_size, '\0');
  bool returns = false;
  while (const std::size_t count = ahead.read(block)) {
    const auto text = std::string_view(block).substr(0, count);
    if (text.find('\n') != std::string_view::npos) return;
    returns = returns || text.find('\r') != std::string_view::npos;
  }
  if (returns) end_ = '\r';
}

/// Discards the text before the current position and appends the next block of the file. @return false at the end
bool Lines::read_on() {
  constexpr std::size_t longest = std::size_t{1} << 26;
  if (!file_) return false;
  buffer_.erase(0, position_);
  position_ = 0;
  const std::size_t left = buffer_.size();
  if (left > longest) fail_at_line(file_->head(), number_ + 1, "the line is longer than 64 MB");
  buffer_.resize(left + block_size);
  const std::size_t count = file_->read(std::span(buffer_).subspan(left));
  buffer_.resize(left + count);
  text_ = buffer_;
  return count > 0;
}

bool Lines::next() {
  if (position_ >= text_.size() && !read_on()) return false;
  std::size_t end = text_.find(end_, position_);
  while (end == std::string_view::npos) {
    const std::size_t searched = text_.size() - position_;
    if (!read_on()) break;
    end = text_.find(end_, searched);
  }
  line_ = text_.substr(position_, end == std::string_view::npos ? end : end - position_);
  position_ = end == std::string_view::npos ? text_.size() : end + 1;
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
  return true;
}

bool Lines::next_filled(std::optional<char> comment) {
  while (next()) {
    if (comment) line_ = without_comment(line_, *comment);
    if (!std::ranges::all_of(line_, is_blank)) return true;
  }
  return false;
}

bool Lines::next_data(std::optional<char> comment) {
  while (next_filled(comment)) {
    if (!is_remark(line_)) return true;
    skipped_.add(number_, line_);
  }
  return false;
}

std::string_view without_comment(std::string_view line, char comment) noexcept {
  std::size_t at = line.find(comment);  // inside a word, as in "1.#INF", it begins no comment
  while (at != std::string_view::npos && at > 0 && !is_blank(line[at - 1])) at = line.find(comment, at + 1);
  return line.substr(0, at);
}

std::string_view next_word(std::string_view& rest) noexcept {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) words.push_back(word);
}

std::string_view without_byte_order_mark(std::string_view text) noexcept {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

bool equals_ignoring_case(std::string_view word, std::string_view lower) noexcept {
  return std::ranges::equal(word, lower, [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a + 32) : a) == b; });
}

std::optional<double> to_real(std::string_view word) noexcept {
  word = without_plus(word);
  double value = 0.0;
  const auto [end, error] = detail::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc{}) return value;
  if (error == std::errc::result_out_of_range && is_underflow(word)) return word.starts_with('-') ? -0.0 : 0.0;
  return std::nullopt;
}

std::optional<std::int64_t> to_whole(std::string_view word) noexcept {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool is_like_number(std::string_view word) { return to_real(with_point(word)).has_value(); }

double real_or_fail(const Input& in, std::int64_t line, std::string_view word) {
  if (const std::optional<double> value = to_real(word)) return *value;
  if (const std::string decimal = with_point(word); to_real(decimal))
    fail_at_line(in, line, in_quotes(word) + " is not a number: decimals take a point, as in " + in_quotes(decimal));
  fail_at_line(in, line, in_quotes(word) + " is not a finite number in double precision");
}

std::int64_t whole_or_fail(const Input& in, std::int64_t line, std::string_view word) {
  if (const std::optional<std::int64_t> value = to_whole(word)) return *value;
  fail_at_line(in, line, in_quotes(word) + " is not a whole number");
}

}  // namespace ahm::io
