#include "read/input.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

#include "ahm/error.hpp"
#include "ahm/types.hpp"
#include "ahm/util/text.hpp"
#include "read/bytes.hpp"

namespace ahm::io {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

/// The UTF-16 unit at an even position.
unsigned unit_at(std::string_view bytes, std::size_t at, bool big_endian) {
  return byte_at(bytes, at + !big_endian) << 8 | byte_at(bytes, at + big_endian);
}

void append_utf8(std::string& text, unsigned character) {
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  const int more = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;  // bytes after the first
  text += static_cast<char>((0xF00u >> more & 0xFFu) | character >> 6 * more);
  for (int k = more - 1; k >= 0; --k) text += static_cast<char>(0x80 | (character >> 6 * k & 0x3F));
}

/// Replaces text in UTF-16 by the same text in UTF-8, without its byte order mark. Halves of pairs become U+FFFD.
void decode_utf16(Input& in) {
  const std::string_view bytes = in.bytes;
  if (bytes.size() % 2 != 0) fail_at_byte(in, bytes.size(), "the text (UTF-16) ends within a character");
  const bool big_endian = byte_at(bytes, 0) == 0xFE;
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at < bytes.size(); at += 2) {
    unsigned character = unit_at(bytes, at, big_endian);
    const unsigned next = at + 2 < bytes.size() ? unit_at(bytes, at + 2, big_endian) : 0;
    if (character >> 10 == 0x36 && next >> 10 == 0x37) {
      character = 0x10000 + ((character & 0x3FF) << 10) + (next & 0x3FF);
      at += 2;
    } else if (character >> 11 == 0x1B) {
      character = 0xFFFD;
    }
    append_utf8(text, character);
  }
  in.bytes = std::move(text);
}

/// Unpacks gzip and converts UTF-16.
void normalize_bytes(Input& in) {
  if (is_gzip(in)) gunzip(in);
  if (is_utf16(in.bytes)) decode_utf16(in);
}

}  // namespace

bool is_utf16(std::string_view bytes) noexcept {
  const bool little = bytes.starts_with("\xFF\xFE"), big = bytes.starts_with("\xFE\xFF");
  if (bytes.size() < 4 || !(little || big)) return false;
  const unsigned first = unit_at(bytes, 2, big);  // ASCII: binary data might begin with the bytes of the mark
  return (first >= '\t' && first <= '\r') || (first >= ' ' && first < 127);
}

Input load(const std::filesystem::path& path) {
  Input in{path, {}};
  const RegularFile file(path);
  in.bytes.resize(file.size());
  if (const std::size_t done = file.read(0, in.bytes); done < in.bytes.size())
    fail_at_byte(in, done, "the file became shorter while it was read; read it again when it is complete");
  check_gzip_name(in);
  normalize_bytes(in);
  return in;
}

namespace {

/// Reads input of unknown size, up to the limit `room_for_input`.
/// @param next  next(in, room, size) reads up to `size` bytes into `room` and returns their number; 0 at the end
template <class Next>
Input load_unnamed(const Next& next) {
  Input in{"-", {}};
  constexpr std::size_t block = std::size_t{1} << 20;
  const std::uint64_t most = room_for_input();
  for (std::size_t done = 0, got = 1; got > 0; in.bytes.resize(done)) {
    in.bytes.resize(done + block);
    got = next(in, in.bytes.data() + done, block);
    done += got;
    if (done > most) fail_too_large(in, "the stream", most);
  }
  if (in.bytes.empty()) fail(in, "the stream is empty (0 bytes)");
  normalize_bytes(in);
  return in;
}

}  // namespace

Input load(std::istream& stream) {
  return load_unnamed([&](const Input& in, char* room, std::size_t size) {
    stream.read(room, static_cast<std::streamsize>(size));
    if (stream.bad()) fail(in, "the stream cannot be read");
    return static_cast<std::size_t>(stream.gcount());
  });
}

Input load_standard_input() {
  return load_unnamed([](const Input& in, char* room, std::size_t size) {
    ssize_t got = -1;
    do got = ::read(STDIN_FILENO, room, size);
    while (got < 0 && errno == EINTR);
    if (got < 0) fail(in, std::generic_category().message(errno));
    return static_cast<std::size_t>(got);
  });
}

void check_gzip_name(const Input& in) {
  if (!is_gzip(in) && lower_extension(in.path) == ".gz")
    fail(in, "the file is named .gz, but is not compressed with gzip");
}

void fail(const Input& in, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ": " + what);
}

void fail_too_large(const Input& in, const std::string& what, std::uint64_t most) {
  throw ResourceExhausted("cannot read " + quoted_path(in.path) + ": " + what + " is larger than " +
                          std::to_string(most >> 20) + " MB, a third of the free memory");
}

void fail_at_line(const Input& in, std::int64_t line, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ", line " + std::to_string(line) + ": " + what);
}

void fail_at_byte(const Input& in, std::size_t byte, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ", byte " + std::to_string(byte) + ": " + what);
}

void check_vertex_count(const Input& in, std::uint64_t count) {
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    fail(in, detail::counted(count, "vertex", "are") + " more than 2147483647, the maximum");
  }
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 48;
  std::string result = "'";
  for (char c : text.substr(0, longest)) result += (c >= ' ' && c < 127) ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

std::string quoted_path(const std::filesystem::path& path) {
  std::string result = "'";
  result += path.string();
  result += '\'';
  return result;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return extension;
}

}  // namespace ahm::io
