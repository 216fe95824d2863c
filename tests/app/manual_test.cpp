// Manual pages and completions are made of the tables that --help prints: what one has, the others have.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <regex>

#include "program.hpp"

namespace ahm::test {
namespace {

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> result;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) result.push_back((*at)[1]);
  return result;
}

std::vector<std::string> subcommands() { return matches(run({"--help"}).out, "\n  ([a-z][a-z-]*) {2,}[A-Z]"); }

std::vector<std::string> options(const std::string& subcommand) {
  return matches(run({subcommand, "--help"}).out, "\n  (?:-[a-z],)?(--[a-z0-9-]+)");
}

std::string without_escapes(std::string text) {
  std::erase(text, '\\');
  return text;
}

TEST(Manual, HasEveryOptionOfTheHelp) {
  ASSERT_GE(subcommands().size(), 10U);
  for (const std::string& name : subcommands()) {
    const Outcome page = run({"manual", name});
    EXPECT_EQ(page.status, 0);
    ASSERT_GE(options(name).size(), 3U) << name;
    for (const std::string& option : options(name))
      EXPECT_NE(without_escapes(page.out).find(option + "fR"), std::string::npos) << name << " " << option;
    EXPECT_NE(without_escapes(run({"manual"}).out).find("fBahm-" + name + "fR"), std::string::npos) << name;
  }
}

TEST(Completion, HasEveryOptionOfTheHelp) {
  const std::string bash = run({"completion", "bash"}).out, zsh = run({"completion", "zsh"}).out,
                    fish = run({"completion", "fish"}).out;
  for (const std::string& name : subcommands())
    for (const std::string& option : options(name)) {
      const std::size_t in_bash = bash.find("\n    " + name + ") "), in_zsh = zsh.find("\n    " + name + ") ");
      ASSERT_NE(in_bash, std::string::npos) << name;
      ASSERT_NE(in_zsh, std::string::npos) << name;
      const std::string words = bash.substr(in_bash, bash.find(";;", in_bash) - in_bash),
                        arguments = zsh.substr(in_zsh, zsh.find(";;", in_zsh) - in_zsh);
      EXPECT_TRUE(std::regex_search(words, std::regex("[ ']" + option + "[ ']"))) << name << " " << option;
      EXPECT_NE(arguments.find("'" + option + "["), std::string::npos) << name << " " << option;
      EXPECT_TRUE(std::regex_search(fish, std::regex("from " + name + "'[^\n]* -l " + option.substr(2) + " ")))
          << name << " " << option;
    }
}

/// What bash offers for the last of some words.
std::string offered(const Folder& folder, const std::string& words) {
  const std::string script = folder.write("ahm.bash", run({"completion", "bash"}).out);
  const std::string command = "cd " + (folder / "") + " && bash -c 'source " + script + "; COMP_WORDS=(" + words +
                              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ahm; echo \"${COMPREPLY[*]}\"'";
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[256];
  while (pipe != nullptr && std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  if (pipe != nullptr) pclose(pipe);
  return text.substr(0, text.find('\n'));
}

TEST(Completion, OffersTheWordsThatAnOptionTakes) {
  if (std::system("bash -c 'type compgen' >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no bash";
  const Folder folder;
  EXPECT_EQ(offered(folder, "ahm logmap --method \"\""), "auto heat polar exact");
  EXPECT_EQ(offered(folder, "ahm logmap --method e"), "exact");
  EXPECT_EQ(offered(folder, "ahm logmap --method = e"), "exact");
  EXPECT_EQ(offered(folder, "ahm logmap --method ="), "auto heat polar exact");
  EXPECT_EQ(offered(folder, "ahm coverage --pattern s"), "spiral");
  EXPECT_EQ(offered(folder, "ahm logmap --output ahm"), "ahm.bash");
  EXPECT_EQ(offered(folder, "ahm logm"), "logmap");
  const std::string zsh = run({"completion", "zsh"}).out, fish = run({"completion", "fish"}).out;
  EXPECT_NE(zsh.find(":(heat exact)'"), std::string::npos);
  EXPECT_NE(fish.find(" -l method -x -a 'heat exact' -d "), std::string::npos);
}

TEST(Completion, RefusesOtherShells) {
  const Outcome outcome = run({"completion", "csh"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("bash, zsh or fish"), std::string::npos);
  EXPECT_EQ(run({"manual", "nothing"}).status, 2);
}

}  // namespace
}  // namespace ahm::test
