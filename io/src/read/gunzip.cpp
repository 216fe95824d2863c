// zlib unpacks. What it makes is bounded: a few megabytes may stand for gigabytes.
#include "read/gunzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include "ahm/error.hpp"
#include "read/free_memory.hpp"

namespace ahm::io {
namespace {

class Inflater {
 public:
  Inflater(const Input& in, std::uint64_t most) : in_(in), most_(most) {
    constexpr int only_gzip = 16 + MAX_WBITS;
    if (::inflateInit2(&stream_, only_gzip) != Z_OK) throw std::bad_alloc();
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { ::inflateEnd(&stream_); }

  std::string all() {
    std::string result;
    for (;;) {
      if (made_ == result.size()) grow(result);
      const int state = step(result);
      if (state == Z_STREAM_END && !next_member()) break;
      if (state != Z_STREAM_END && taken_ == in_.bytes.size() && made_ < result.size())
        fail_at_byte(in_, taken_, "the compressed data ends here, but not what it stands for; the file is cut short");
    }
    result.resize(made_);
    return result;
  }

 private:
  /// Twice as much room, from four times the file on.
  void grow(std::string& result) const {
    constexpr std::size_t least = 1 << 16;
    if (result.size() >= most_)
      throw ResourceExhausted("cannot read " + quoted_path(in_.path) + ": unpacked it is larger than " +
                              std::to_string(most_ >> 20) + " MB, a third of the memory that is free");
    const std::uint64_t wanted = result.empty() ? 4 * in_.bytes.size() : 2 * result.size();
    result.resize(std::min<std::uint64_t>(most_, std::max<std::uint64_t>(wanted, least)));
  }

  int step(std::string& result) {
    constexpr std::size_t longest = std::numeric_limits<uInt>::max();
    const std::size_t give = std::min(longest, in_.bytes.size() - taken_),
                      room = std::min(longest, result.size() - made_);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in_.bytes.data() + taken_));
    stream_.avail_in = static_cast<uInt>(give);
    stream_.next_out = reinterpret_cast<Bytef*>(result.data() + made_);
    stream_.avail_out = static_cast<uInt>(room);
    const int state = ::inflate(&stream_, Z_NO_FLUSH);
    taken_ += give - stream_.avail_in;
    made_ += room - stream_.avail_out;
    if (state == Z_MEM_ERROR) throw std::bad_alloc();
    if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
      fail_at_byte(in_, taken_,
                   std::string("the compressed data is damaged (zlib: ") +
                       (stream_.msg != nullptr ? stream_.msg : "a dictionary is missing") + ")");
    return state;
  }

  /// Whether another member follows. Zeros may fill the last block of a tape.
  bool next_member() {
    const std::string_view rest = std::string_view(in_.bytes).substr(taken_);
    if (rest.find_first_not_of('\0') == std::string_view::npos) return false;
    if (!rest.starts_with("\x1f\x8b")) fail_at_byte(in_, taken_, "the file goes on behind its compressed data");
    ::inflateReset(&stream_);
    return true;
  }

  const Input& in_;
  std::uint64_t most_;
  z_stream stream_{};
  std::size_t taken_ = 0, made_ = 0;
};

}  // namespace

bool is_gzip(const Input& in) { return in.bytes.starts_with("\x1f\x8b"); }

void gunzip(Input& in) {
  in.bytes = Inflater(in, free_memory() / 3).all();
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
