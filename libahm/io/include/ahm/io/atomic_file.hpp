/// \file
/// Output files that appear complete or not at all.
///
/// \code
/// ahm::io::AtomicFile file("result.csv");
/// file.write("index,x,y,z\n");
/// file.commit();                            // only now does result.csv exist, or change
/// \endcode
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::io {

/// Writes to a temporary file in the target's directory and renames it on `commit`. Without a commit, the destructor removes
/// the temporary file. The next process that writes to the directory removes temporary files of killed processes.
///
/// Pipes and devices (/dev/stdout) are written directly. For a symbolic link, the file that it points to is replaced; its
/// permissions are preserved.
class AtomicFile {
  friend class FileSet;

 public:
  /// @throws IoError with the system's reason when the file cannot be created
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes.
  /// @throws IoError when the disk is full, the pipe is closed (fault "pipe_closed"), or the system reports another error
  void write(std::string_view bytes);
  /// Path of the temporary file, for libraries that open the file themselves instead of calling `write`. Empty if the target
  /// is written directly.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Flushes the buffer to the disk. If several files belong together, finish all of them before committing the first.
  /// @throws IoError as `write`
  void finish();
  /// Finishes the file if necessary and renames it to the target. Inside a `FileSet`, `FileSet::commit` renames it.
  /// @throws IoError as `write`
  void commit();

 private:
  bool create_temporary();
  void flush();
  void name();
  void discard() noexcept;
  [[noreturn]] void fail(int error);

  std::filesystem::path path_;       // path from the caller, for messages
  std::filesystem::path target_;     // path with symbolic links resolved
  std::filesystem::path temporary_;  // empty if the target is written directly
  std::string buffer_;
  int descriptor_ = -1;
  bool finished_ = false;
  int slot_ = -1;  // index in the registry of unfinished files
};

/// A group of files that appear together. While a set exists, files committed by this thread keep their temporary names;
/// `commit` then renames all of them in a row. Sets can be nested; a file belongs to the innermost set.
class FileSet {
 public:
  FileSet() noexcept;
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// Renames the files of this thread's innermost set, if there is a set. @throws IoError if a file cannot be renamed
  static void commit();

 private:
  friend class AtomicFile;
  static thread_local FileSet* innermost;
  FileSet* outer_;
  std::vector<AtomicFile> files_;
};

/// The bytes that `write` writes to the path that it receives, a temporary file.
/// @param name  name of the file, which selects the format
/// @throws IoError; as `write`
std::string written_bytes(const std::string& name, const std::function<void(const std::filesystem::path&)>& write);

/// Whether the path cannot be replaced by renaming a file: it is a pipe, a device, or the process's own output
/// (/dev/stdout, even if redirected to a file).
bool is_stream(const std::filesystem::path& path);

/// The file that an `AtomicFile` with this path creates or replaces: the end of a chain of symbolic links, which need not exist.
std::filesystem::path without_links(std::filesystem::path path);

/// Deletes the temporary files of all uncommitted `AtomicFile`s of the process. A thread that afterwards creates an
/// `AtomicFile`, or fails because its file is gone, blocks until the process ends. Async-signal-safe: for a handler of SIGINT,
/// SIGTERM or SIGHUP that then ends the process.
void remove_unfinished_files() noexcept;

}  // namespace ahm::io
