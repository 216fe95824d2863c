// The unpacked size is limited, because a few compressed megabytes may unpack to gigabytes.
#include "read/gunzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "ahm/error.hpp"
#include "read/bytes.hpp"
#include "read/input.hpp"

namespace ahm::io {

class Gunzip::Inflater {
 public:
  Inflater(const Input& in, std::function<std::string_view()> more) : in_(in), more_(std::move(more)) {
    constexpr int only_gzip = 16 + MAX_WBITS;
    if (::inflateInit2(&stream_, only_gzip) != Z_OK) throw std::bad_alloc();
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { ::inflateEnd(&stream_); }

  std::size_t read(std::span<char> room) {
    std::size_t made = 0;
    while (made < room.size() && !done_) {
      fetch();
      made += step(room.subspan(made));
      if (member_ends_)
        done_ = !next_member();
      else if (made < room.size() && !fetch())
        fail_at_byte(in_, taken_, "the compressed data is incomplete; the file is cut short");
    }
    return made;
  }

 private:
  /// Gets the next bytes if necessary. @return whether there are bytes to unpack
  bool fetch() {
    if (given_.empty() && !ended_) {
      given_ = more_();
      ended_ = given_.empty();
    }
    return !given_.empty();
  }

  std::size_t step(std::span<char> room) {
    constexpr std::size_t longest = std::numeric_limits<uInt>::max();
    const std::size_t give = std::min(longest, given_.size()), most = std::min(longest, room.size());
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(given_.data()));
    stream_.avail_in = static_cast<uInt>(give);
    stream_.next_out = reinterpret_cast<Bytef*>(room.data());
    stream_.avail_out = static_cast<uInt>(most);
    const int state = ::inflate(&stream_, Z_NO_FLUSH);
    take(give - stream_.avail_in);
    if (state == Z_MEM_ERROR) throw std::bad_alloc();
    if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
      fail_at_byte(in_, taken_,
                   std::string("the compressed data is damaged (zlib: ") +
                       (stream_.msg != nullptr ? stream_.msg : "a dictionary is missing") + ")");
    member_ends_ = state == Z_STREAM_END;
    return most - stream_.avail_out;
  }

  void take(std::size_t bytes) {
    given_.remove_prefix(bytes);
    taken_ += bytes;
  }

  /// Whether another member follows. Ignores zeros at the end, which may fill the last block of a tape.
  bool next_member() {
    if (!fetch()) return false;
    const std::size_t begin = taken_;
    if (given_.front() == '\x1f') return ::inflateReset(&stream_) == Z_OK;
    while (fetch()) {
      if (given_.find_first_not_of('\0') != std::string_view::npos)
        fail_at_byte(in_, begin, "the file continues after its compressed data");
      take(given_.size());
    }
    return false;
  }

  const Input& in_;
  std::function<std::string_view()> more_;
  std::string_view given_;
  z_stream stream_{};
  std::size_t taken_ = 0;  ///< number of bytes of the file that have been unpacked
  bool ended_ = false, member_ends_ = false, done_ = false;
};

Gunzip::Gunzip(const Input& in, std::function<std::string_view()> more)
    : inflater_(std::make_unique<Inflater>(in, std::move(more))) {}

Gunzip::~Gunzip() = default;

std::size_t Gunzip::read(std::span<char> room) { return inflater_->read(room); }

namespace {

/// Doubles the size of `room`, starting at four times the size of the file.
void grow(const Input& in, std::uint64_t most, std::string& room) {
  constexpr std::size_t least = 1 << 16;
  if (room.size() >= most) fail_too_large(in, "its unpacked content", most);
  const std::uint64_t wanted = room.empty() ? 4 * in.bytes.size() : 2 * room.size();
  room.resize(std::min<std::uint64_t>(most, std::max<std::uint64_t>(wanted, least)));
}

}  // namespace

bool is_gzip(const Input& in) { return in.bytes.starts_with("\x1f\x8b"); }

void gunzip(Input& in) {
  const std::uint64_t most = room_for_input();
  Gunzip packed(in, [all = std::string_view(in.bytes)]() mutable { return std::exchange(all, {}); });
  std::string result;
  std::size_t made = 0;
  while (made == result.size()) {
    grow(in, most, result);
    made += packed.read(std::span(result).subspan(made));
  }
  result.resize(made);
  in.bytes = std::move(result);
  if (in.bytes.empty()) fail(in, "the file is empty (0 bytes) when unpacked");
}

void inflate_block(const Input& in, std::string_view packed, std::span<char> room, const std::string& what) {
  auto made = static_cast<uLongf>(room.size());
  const int state = ::uncompress(reinterpret_cast<Bytef*>(room.data()), &made,
                                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (state == Z_MEM_ERROR) throw std::bad_alloc();
  if (state != Z_OK || made != room.size()) fail(in, what + " is damaged: its compressed data (zlib) does not unpack");
}

}  // namespace ahm::io
