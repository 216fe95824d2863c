#include "read/input.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

#include "ahm/error.hpp"
#include "ahm/types.hpp"
#include "read/gunzip.hpp"

namespace ahm::io {
namespace {

/// Closes a file descriptor when it leaves scope.
struct Descriptor {
  int value;
  explicit Descriptor(int fd) : value(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

[[noreturn]] void fail_with_errno(const Input& in, int error) { fail(in, std::generic_category().message(error)); }

}  // namespace

Input load(const std::filesystem::path& path) {
  Input in{path, {}};
  // Not blocking, so that a named pipe nobody writes to is refused rather than waited for.
  Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (fd.value < 0 || ::fstat(fd.value, &info) != 0) fail_with_errno(in, errno);
  if (S_ISDIR(info.st_mode)) fail_with_errno(in, EISDIR);
  if (!S_ISREG(info.st_mode)) fail(in, "not a regular file (a pipe or device); copy its contents to a file first");
  if (info.st_size == 0) fail(in, "the file is empty (0 bytes)");

  in.bytes.resize(info.st_size);
  std::size_t done = 0;
  while (done < in.bytes.size()) {
    const ssize_t got = ::read(fd.value, in.bytes.data() + done, in.bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_with_errno(in, errno);
    if (got == 0)
      fail_at_byte(in, done, "the file became shorter while it was read; read it again when it is complete");
    done += static_cast<std::size_t>(got);
  }
  if (is_gzip(in)) {
    gunzip(in);
  } else if (lower_extension(path) == ".gz") {
    fail(in, "the file is named .gz, but is not compressed with gzip");
  }
  return in;
}

Input load(std::istream& stream) {
  Input in{"-", {}};
  constexpr std::size_t block = std::size_t{1} << 20;
  for (std::size_t done = 0; stream; in.bytes.resize(done)) {
    in.bytes.resize(done + block);
    stream.read(in.bytes.data() + done, block);
    done += static_cast<std::size_t>(stream.gcount());
  }
  if (stream.bad()) fail(in, "the stream cannot be read");
  if (in.bytes.empty()) fail(in, "the stream is empty (0 bytes)");
  if (is_gzip(in)) gunzip(in);
  return in;
}

void fail(const Input& in, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ": " + what);
}

void fail_at_line(const Input& in, std::int64_t line, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ", line " + std::to_string(line) + ": " + what);
}

void fail_at_byte(const Input& in, std::size_t byte, const std::string& what) {
  throw IoError("cannot read " + quoted_path(in.path) + ", byte " + std::to_string(byte) + ": " + what);
}

void check_vertex_count(const Input& in, std::uint64_t count) {
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    fail(in, std::to_string(count) + " vertices are more than 2147483647, the most this library can number");
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
