// Long work shows how far it is, where somebody sits at a terminal.
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recordings.hpp"
#include "run_program.hpp"
#include "sweep_example.hpp"

namespace {

/// What slipfit writes to standard error where that is a terminal; standard output goes into `out`.
std::string shown_on_terminal(std::vector<std::string> arguments, const std::string& out) {
  arguments.insert(arguments.begin(), SLIPFIT_EXECUTABLE);
  std::vector<char*> words;
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  int terminal = -1;
  int inside = -1;
  REQUIRE(::openpty(&terminal, &inside, nullptr, nullptr, nullptr) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const bool has_output = std::freopen(out.c_str(), "w", stdout) != nullptr;
    if (has_output && ::dup2(inside, STDERR_FILENO) >= 0) ::execv(words.front(), words.data());
    std::_Exit(127);
  }
  ::close(inside);
  std::string shown;
  std::array<char, 4096> part{};
  for (ssize_t count = 0; (count = ::read(terminal, part.data(), part.size())) > 0;) {
    shown.append(part.data(), static_cast<std::size_t>(count));
  }
  ::close(terminal);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  return shown;
}

}  // namespace

TEST_CASE("a joint fit shows its steps on a terminal alone, and takes them off it") {
  const test::SweepExample example;
  const std::vector<std::string> command{"fit", "--joint", example.manifest, "--group", "pad", "--json"};
  const std::string out = example.folder.path("out.json");
  const std::string shown = shown_on_terminal(command, out);
  CHECK_THAT(shown, Catch::Contains("analysing recording 3 of 3") && Catch::Contains("fitting 3 recordings together") &&
                        Catch::Contains("fitting without recording 3 of 3") && Catch::EndsWith("\r\x1b[K"));
  CHECK(nlohmann::json::parse(test::content_of(out))["id"] == "pad");
  CHECK(test::run_slipfit(command).err.empty());
  std::vector<std::string> quiet = command;
  quiet.push_back("--quiet");
  CHECK(shown_on_terminal(quiet, out).empty());
}

TEST_CASE("compare shows which recording it fits on a terminal alone") {
  const test::SweepExample example;
  const std::string slow = example.folder.path("slow.csv");
  const std::string fast = example.folder.path("fast.csv");
  const std::vector<std::string> command{"compare", slow, fast, "--speed", "20mm/s", "--speed", "80mm/s"};
  CHECK_THAT(shown_on_terminal(command, example.folder.path("out.txt")), Catch::Contains("fitting recording 2 of 2"));
  CHECK(test::run_slipfit(command).err.empty());
}
