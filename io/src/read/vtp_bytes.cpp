#include "read/vtp_bytes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "ahm/error.hpp"
#include "read/free_memory.hpp"
#include "read/gunzip.hpp"
#include "read/vtk_data.hpp"

namespace ahm::io {
namespace {

/// Bytes one after the other, raw or out of base64, in which padding may stand wherever a part was encoded for itself.
class Bytes {
 public:
  Bytes(const Input& in, std::string_view text, bool base64, const std::string& what)
      : in_(in), text_(text), base64_(base64), what_(what) {}

  /// The most bytes that can follow.
  std::uint64_t left() const { return base64_ ? spare_.size() + text_.size() / 4 * 3 : text_.size(); }

  std::string take(std::uint64_t count) {
    if (count > left()) fail_short();
    std::string bytes;
    if (!base64_) {
      bytes = text_.substr(0, count);
      text_.remove_prefix(count);
      return bytes;
    }
    bytes = std::move(spare_);
    bytes.reserve(count + 2);
    while (bytes.size() < count) decode_four(bytes);
    spare_ = bytes.substr(count);
    bytes.resize(count);
    return bytes;
  }

  std::uint64_t take_length(const VtpEncoding& encoding) {
    const VtkType type = *find_vtk_type(encoding.wide_header ? "UInt64" : "UInt32");
    const double length = type.load(take(type.size), 0, encoding.big_endian);
    constexpr double most = 9007199254740992;  // 2^53: no file is larger
    if (length > most) fail_short();
    return static_cast<std::uint64_t>(length);
  }

  [[noreturn]] void fail_short() const { fail(in_, what_ + " is cut short, or its length is wrong"); }

 private:
  void decode_four(std::string& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t bits = 0;
    std::size_t count = 0, padding = 0;
    for (; count < 4 && !text_.empty(); text_.remove_prefix(1)) {
      const char c = text_.front();
      if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
      const std::size_t digit = c == '=' && count >= 2 ? 0 : digits.find(c);
      if (digit == std::string_view::npos || (padding > 0 && c != '='))
        fail(in_, what_ + " is not base64: it holds " + in_quotes(std::string_view(&c, 1)));
      padding += c == '=';
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
      ++count;
    }
    if (count < 4) fail_short();
    for (std::size_t k = 0; k + padding < 3; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k));
  }

  const Input& in_;
  std::string_view text_;
  bool base64_;
  const std::string& what_;
  std::string spare_;  ///< decoded, and not taken yet
};

/// Number of blocks, their size, the size of the last one where it is another; the compressed size of each; the blocks.
std::string unpack(const Input& in, Bytes& bytes, const VtpEncoding& encoding, const std::string& what) {
  const std::uint64_t count = bytes.take_length(encoding), size = bytes.take_length(encoding),
                      last = bytes.take_length(encoding);
  if (count == 0) return {};
  constexpr std::uint64_t most_packed = 1032;  // zlib makes nothing smaller than a 1032nd of it
  const std::uint64_t most = free_memory() / 3;
  if (count > bytes.left() || last > size || (size > 0 && count - 1 > most_packed * bytes.left() / size))
    bytes.fail_short();
  if (size > 0 && count > most / size)
    throw ResourceExhausted("cannot read " + quoted_path(in.path) + ": " + what +
                            " would fill more than a third of the memory that is free");
  const std::uint64_t all = (count - 1) * size + (last == 0 ? size : last);
  if (all > most_packed * bytes.left()) bytes.fail_short();
  std::vector<std::uint64_t> packed(count);
  for (std::uint64_t& length : packed) length = bytes.take_length(encoding);
  std::string result(all, '\0');
  for (std::uint64_t b = 0; b < count; ++b) {
    const std::uint64_t begin = b * size;
    inflate_block(in, bytes.take(packed[b]),
                  std::span(result).subspan(begin, std::min<std::uint64_t>(size, result.size() - begin)), what);
  }
  return result;
}

}  // namespace

std::string decode_vtp_array(const Input& in, std::string_view text, bool base64, const VtpEncoding& encoding,
                             const std::string& what) {
  Bytes bytes(in, text, base64, what);
  if (encoding.compressed) return unpack(in, bytes, encoding, what);
  const std::uint64_t length = bytes.take_length(encoding);
  return bytes.take(length);
}

}  // namespace ahm::io
