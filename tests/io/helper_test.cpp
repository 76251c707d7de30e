#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "io/container/formats.hpp"
#include "temp_file.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using io_test::TempFile;
using slipfit::reading::Helper;

namespace {

slipfit::FileHandle in_memory(const TempFile& file) {
  return slipfit::reading::file_in_memory(*slipfit::reading::open_plain(file.path()).bytes, "file");
}

/// A shell script as the program that reads a file for slipfit; its input is the text "input".
class ScriptAsHelper {
 public:
  explicit ScriptAsHelper(const std::string& script) : script_("#!/bin/sh\n" + script) {
    const fs::path folder = fs::path(script_.path()).parent_path();
    fs::permissions(script_.path(), fs::perms::owner_all);
    ::setenv("SLIPFIT_HELPERS", ("/no/such/folder:" + folder.string()).c_str(), 1);
  }
  ~ScriptAsHelper() { ::unsetenv("SLIPFIT_HELPERS"); }
  ScriptAsHelper(const ScriptAsHelper&) = delete;
  ScriptAsHelper& operator=(const ScriptAsHelper&) = delete;

  /// All that it writes, the first line without its "=".
  [[nodiscard]] std::string output(std::chrono::milliseconds longest_wait = std::chrono::minutes(1)) const {
    const TempFile input("input");
    const std::string program = fs::path(script_.path()).filename().string();
    const Helper helper{program, {slipfit::reading::kFileOfHelper}, "a test", "dash", longest_wait};
    const auto read = slipfit::reading::run_helper(helper, in_memory(input), "file");
    return read.first + "|" + slipfit::reading::read_all(*read.bytes, 1 << 20).value();
  }

  [[nodiscard]] slipfit::Error error(std::chrono::milliseconds longest_wait = std::chrono::minutes(1)) const {
    try {
      (void)output(longest_wait);
    } catch (const slipfit::ThrownError& thrown) {
      return thrown.error();
    }
    FAIL("no error");
    return {};
  }

 private:
  TempFile script_;
};

}  // namespace

TEST_CASE("a helper is found in the folders of SLIPFIT_HELPERS and reads the input from memory") {
  CHECK(ScriptAsHelper("echo =first; cat $1").output() == "first|input");
}

TEST_CASE("a helper that is not found is named, with the variable for its folder") {
  const TempFile input("input");
  const Helper helper{"slipfit-none", {}, "a test", "none-dev"};
  CHECK_THROWS_WITH(slipfit::reading::run_helper(helper, in_memory(input), "file"),
                    Contains("slipfit-none") && Contains("SLIPFIT_HELPERS") && Contains("none-dev"));
}

TEST_CASE("a helper that does not end is killed after its time, before and behind its first line") {
  for (const std::string begin : {"", "echo =first; "}) {
    const auto start = std::chrono::steady_clock::now();
    const slipfit::Error error = ScriptAsHelper(begin + "exec sleep 100").error(std::chrono::milliseconds(200));
    CHECK(error.code == "damaged_container");
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  }
}

TEST_CASE("a helper inherits no ignored and no blocked signals") {
  sigset_t blocked{};
  ::sigemptyset(&blocked);
  ::sigaddset(&blocked, SIGHUP);
  sigset_t before{};
  ::sigprocmask(SIG_BLOCK, &blocked, &before);
  const auto handler = std::signal(SIGTERM, SIG_IGN);
  const std::string blocked_there = ScriptAsHelper("echo =; exec grep SigBlk: /proc/self/status").output();
  const std::string ignored_there = ScriptAsHelper("echo =; exec grep SigIgn: /proc/self/status").output();
  (void)std::signal(SIGTERM, handler);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  CHECK(blocked_there == "|SigBlk:\t0000000000000000\n");
  const std::size_t ignored = std::stoull(ignored_there.substr(ignored_there.find('\t') + 1), nullptr, 16);
  CHECK((ignored & 0x7FFFFFFFU) == 0);  // signals 32 and 33 are glibc's own
}

TEST_CASE("a helper that another program stops does not make the file damaged") {
  const slipfit::Error error = ScriptAsHelper("kill -TERM $$").error();
  CHECK(error.code == "not_readable");
  CHECK_THAT(error.message, Contains("read it again"));
}
