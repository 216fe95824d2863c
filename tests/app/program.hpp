/// \file
/// Runs the built program as a user would, and reads what it leaves behind.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ahm/types.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::test {

/// How a run ended and what it printed.
struct Outcome {
  int status = -1;  ///< exit status, or 128 + signal
  std::string out, err;
};

/// A program started and not yet waited for.
struct Running {
  pid_t pid = -1;
  int out = -1, err = -1;  ///< read ends of the pipes
};

/// Whether a pseudo-terminal can be had.
bool has_terminals();

/// Starts the program with pipes at its outputs, or with a terminal at its standard error.
/// @param input  file at its standard input
Running start(const std::vector<std::string>& arguments, bool on_terminal = false,
              const std::string& input = "/dev/null");
Outcome finish(Running running);
/// The same with the program stopped ten times as long as it runs, as on a slow machine, for its first second of work.
Outcome finish_slowly(Running running);

/// Reads its standard error until a word has come, or the end.
std::string read_until(const Running& running, const std::string& word);

/// start, then finish.
Outcome run(const std::vector<std::string>& arguments);

/// A directory of its own for one test, removed with everything in it.
class Folder : public TemporaryFolder {
 public:
  std::string operator/(const std::string& name) const { return (directory() / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  /// Names of all files, sorted, hidden ones included.
  std::vector<std::string> files() const;
};

/// One row of the program's CSV.
struct Row {
  long index;
  Vec3 position;
  double u, v, distance, angle;
  std::string status;
};

/// Reads the CSV; fails the running test when the header or a row is not as documented.
std::vector<Row> read_csv(const std::string& path);

/// A row of numbers by the names of the columns; words count as 0.
using NumberRow = std::map<std::string, double>;

/// Reads any CSV; fails the running test when a row is not as long as the header.
std::vector<NumberRow> read_numbers(const std::string& path);

std::string read_text(const std::string& path);
nlohmann::json read_json(const std::string& path);

/// Points (and normals) as an XYZ file of full precision.
std::string xyz(const std::vector<Vec3>& points, const std::vector<Vec3>& normals = {});

/// A jittered plane z = 0 in [0, 1]^2 of m x m points. Point 0 is its middle.
std::vector<Vec3> plane(int m);

/// n points evenly on the unit sphere; point 0 is (0, 0, 1).
std::vector<Vec3> sphere(int n);

}  // namespace ahm::test
