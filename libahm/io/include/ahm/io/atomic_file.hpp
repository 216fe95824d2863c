/// \file
/// Output files that are whole or not there.
///
/// \code
/// ahm::io::AtomicFile file("result.csv");
/// file.write("index,x,y,z\n");
/// file.commit();                            // only now does result.csv exist, or change
/// \endcode
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ahm/error.hpp"

namespace ahm::io {

/// Writes to a temporary name in the target's directory and renames on `commit`; without a commit nothing is left
/// behind. What a process that was killed left in that directory is removed when the next one writes there.
///
/// A target that is a pipe or a device (/dev/stdout) is written to directly. A symbolic link is followed, and the file
/// it leads to is replaced, with its permissions kept.
class AtomicFile {
  friend class FileSet;

 public:
  /// @throws IoError with the system's reason when the file cannot be created
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes. @throws IoError when the disk is full, the pipe is closed (fault "pipe_closed"), or the system reports
  /// another fault
  void write(std::string_view bytes);
  /// The name the file has until `commit`, for libraries that open it themselves (instead of `write`); empty where the
  /// target is written directly.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Writes what is left and waits until it is on the disk: for several files, of which none is to be had without the others.
  /// @throws IoError as `write`
  void finish();
  /// `finish`, unless that has been done, and gives the file its name, or has its `FileSet` do so. @throws IoError as `write`
  void commit();

 private:
  bool create_temporary();
  void flush();
  void name();
  void discard() noexcept;
  [[noreturn]] void fail(int error);

  std::filesystem::path path_;       // as the caller named it, for messages
  std::filesystem::path target_;     // without symbolic links
  std::filesystem::path temporary_;  // empty when written directly
  std::string buffer_;
  int descriptor_ = -1;
  bool finished_ = false;
  int slot_ = -1;  // in the registry of unfinished files
};

/// Files that are to be had together: those that this thread commits while the set lives get their names when it is committed, one
/// right after the other, and none without. Sets may be nested; files belong to the innermost.
class FileSet {
 public:
  FileSet() noexcept;
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// Of the innermost set of this thread, if there is one. @throws IoError where a file cannot be renamed
  static void commit();

 private:
  friend class AtomicFile;
  static thread_local FileSet* innermost;
  FileSet* outer_;
  std::vector<AtomicFile> files_;
};

/// Whether a path leads to what cannot be replaced by a renamed file: a pipe, a device, or the process's own output
/// (/dev/stdout), wherever that has been redirected to.
bool is_stream(const std::filesystem::path& path);

/// The file that an `AtomicFile` of this path makes or replaces: what a chain of symbolic links leads to, whether it exists or not.
std::filesystem::path without_links(std::filesystem::path path);

/// Deletes the temporary files of all uncommitted `AtomicFile`s of the process, whatever its other threads do: one that
/// wants another `AtomicFile` from now on, or misses its own, waits for the end. Async-signal-safe: for a handler of
/// SIGINT, SIGTERM or SIGHUP that ends the process afterwards.
void remove_unfinished_files() noexcept;

}  // namespace ahm::io
