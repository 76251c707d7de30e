#include "core/platform.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

using slipfit::platform::processors_of_groups;

namespace {

/// A folder for one test, gone behind it.
struct Groups {
  std::filesystem::path root = std::filesystem::temp_directory_path() / "slipfit-control-groups";

  Groups() { std::filesystem::create_directories(root / "slurm/job"); }
  Groups(const Groups&) = delete;
  Groups& operator=(const Groups&) = delete;
  Groups(Groups&&) = delete;
  Groups& operator=(Groups&&) = delete;
  ~Groups() { std::filesystem::remove_all(root); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(root / name) << text; }
  [[nodiscard]] std::optional<std::size_t> processors() const { return processors_of_groups(root / "groups", root); }
};

}  // namespace

TEST_CASE("control groups limit the processors, those above a process's own too") {
  const Groups groups;
  CHECK_FALSE(groups.processors());
  groups.write("groups", "0::/slurm/job\n");
  CHECK_FALSE(groups.processors());
  groups.write("slurm/job/cpu.max", "max 100000\n");
  CHECK_FALSE(groups.processors());
  groups.write("slurm/cpu.max", "350000 100000\n");
  CHECK(groups.processors() == 4U);
  groups.write("slurm/job/cpu.max", "50000 100000\n");
  CHECK(groups.processors() == 1U);
  CHECK(slipfit::platform::processors() >= 1);
}

TEST_CASE("a nameless file contains what is written to it") {
  const int file = slipfit::platform::open_nameless_file();
  REQUIRE(file >= 0);
  CHECK(::write(file, "abc", 3) == 3);
  char read[3] = {};
  CHECK(::pread(file, read, 3, 0) == 3);
  CHECK(std::string(read, 3) == "abc");
  CHECK(slipfit::platform::sync_data(file));
  ::close(file);
}
