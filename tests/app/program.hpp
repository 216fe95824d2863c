/// \file
/// Runs the built program as a user does, and reads its outputs.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ahm/types.hpp"
#include "support/temporary_folder.hpp"

namespace ahm::test {

using Words = std::vector<std::string>;

/// A test with an empty working directory, which is removed afterwards with all files in it.
class InFolder : public testing::Test {
 protected:
  InFolder() { std::filesystem::current_path(folder_.directory()); }
  ~InFolder() override { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
  TemporaryFolder folder_;
};

/// A test in an empty folder (`InFolder`). Skipped in builds that cannot read and write images.
class InFolderWithImages : public InFolder {
 protected:
  void SetUp() override;
};

void write(const std::string& file, const std::string& bytes);
std::string read_text(const std::string& file);
nlohmann::json read_json(const std::string& file);
/// Names of all files of the working directory, sorted, including hidden files.
Words files();

/// Exit status of a run (128 + signal if a signal ended it) and what it printed.
struct Outcome {
  int status = -1;
  std::string out, err;
};

/// A program that was started and not waited for.
struct Running {
  pid_t pid = -1;
  int out = -1, err = -1;  ///< read ends of the pipes
};

/// Whether the system provides pseudo-terminals.
bool has_terminals();

/// Starts the program with pipes at its outputs, or with a terminal at its standard error.
/// @param command  arguments, separated by blanks; text between single quotes is one argument
/// @param input  file at its standard input
Running start(const std::string& command, bool on_terminal = false, const std::string& input = "/dev/null");
/// @param slowly  for its first second of work the program is stopped ten times as long as it runs, as on a slow machine
Outcome finish(const Running& running, bool slowly = false);
/// Reads its standard error until a word appears, or to the end.
std::string read_until(const Running& running, const std::string& word);

Outcome run(const std::string& command);
/// Runs a command that must succeed.
Outcome run_ok(const std::string& command);
/// Runs `command --json -`, which must succeed, and returns the summary.
nlohmann::json summary(const std::string& command);

/// A row of a CSV file. Words are NaN or 0 in `numbers`.
struct Row {
  std::map<std::string, double> numbers;
  std::string status;  ///< of the column status or kind

  double operator[](const std::string& column) const { return numbers.at(column); }
  Vec3 position() const { return {numbers.at("x"), numbers.at("y"), numbers.at("z")}; }
};

/// Reads a CSV file; the running test fails unless all rows are as long as the header.
std::vector<Row> read_csv(const std::string& file);
/// Runs `command -o table.csv`, which must succeed, and returns the rows.
std::vector<Row> table(const std::string& command);
std::size_t count(const std::vector<Row>& rows, const std::string& status);

/// The lines of an .obj file that begin with a keyword, as numbers; slashes are blanks.
std::vector<std::vector<double>> obj_lines(const std::string& file, const std::string& keyword);

testing::AssertionResult has_all(const std::string& text, const Words& parts);
/// Whether a text contains all parts.
template <class... Parts>
testing::AssertionResult has(const std::string& text, const Parts&... parts) {
  return has_all(text, {parts...});
}

/// A command that must fail.
struct Refusal {
  std::string arguments;
  int status;   ///< 2: wrong command line, 1: other errors
  Words parts;  ///< of the message
};

/// Runs `command` with the arguments of each refusal. Each run must print an error and nothing else, and change no file.
void expect_refused(const std::string& command, const std::vector<Refusal>& refusals);

/// Values by JSON pointer.
using Values = std::vector<std::pair<std::string, nlohmann::json>>;
void expect_values(const nlohmann::json& json, const Values& values);
/// The number at a JSON pointer.
double number(const nlohmann::json& json, const std::string& pointer);

/// Tests of `ahm logmap` on one input file.
class LogmapOf : public InFolder {
 protected:
  explicit LogmapOf(std::string file) : file_(std::move(file)) {}
  /// Writes the file and returns its map; sets `json` and `err`.
  std::vector<Row> map(const std::string& bytes, const std::string& options = "-s 0");
  /// Writes the file and expects an error that contains the text.
  void expect_error(const std::string& bytes, const std::string& text, const std::string& options = "-s 0");

  nlohmann::json json;  ///< summary of the last map
  std::string err;      ///< its warnings

 private:
  std::string file_;
};

inline constexpr double pi = std::numbers::pi;
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double distance(const Vec3& a, const Vec3& b);

}  // namespace ahm::test
