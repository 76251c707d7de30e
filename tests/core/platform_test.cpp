#include "core/platform.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

using slipfit::platform::processors_of_groups;

namespace {

/// A folder for one test, gone behind it: tests run side by side.
struct Groups {
  std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("slipfit-control-groups-" + std::to_string(std::random_device{}()));

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

TEST_CASE("control groups of version 1 limit the processors") {
  const Groups groups;
  std::filesystem::create_directories(groups.root / "cpu,cpuacct/slurm/job");
  groups.write("groups", "5:memory:/slurm/job\n4:cpu,cpuacct:/slurm/job\n3:cpuset:/slurm/job\n");
  CHECK_FALSE(groups.processors());
  groups.write("cpu,cpuacct/slurm/job/cpu.cfs_quota_us", "-1\n");
  groups.write("cpu,cpuacct/slurm/job/cpu.cfs_period_us", "100000\n");
  CHECK_FALSE(groups.processors());
  groups.write("cpu,cpuacct/slurm/cpu.cfs_quota_us", "250000\n");
  CHECK_FALSE(groups.processors());  // a quota without its period
  groups.write("cpu,cpuacct/slurm/cpu.cfs_period_us", "100000\n");
  CHECK(groups.processors() == 3U);
  groups.write("cpu,cpuacct/slurm/job/cpu.cfs_quota_us", "200000\n");
  CHECK(groups.processors() == 2U);
  groups.write("groups", "4:cpuset:/slurm/job\n");
  CHECK_FALSE(groups.processors());
}

TEST_CASE("both versions of control groups at once, and paths that a container does not have") {
  const Groups groups;
  std::filesystem::create_directories(groups.root / "cpu");
  groups.write("groups", "7:cpuacct,cpu:/docker/0123/job\n0::/slurm\n");
  groups.write("cpu/cpu.cfs_quota_us", "400000\n");
  groups.write("cpu/cpu.cfs_period_us", "100000\n");
  CHECK(groups.processors() == 4U);
  groups.write("slurm/cpu.max", "150000 100000\n");
  CHECK(groups.processors() == 2U);
}

TEST_CASE("lines of /proc/self/cgroup that name no control group are passed over") {
  using slipfit::platform::control_group_in;
  for (const char* const line : {"", "0", "0:", "0::", "::relative", "1:name=systemd:/a", "2:cpuset:/a"}) {
    CAPTURE(line);
    CHECK_FALSE(control_group_in(line));
  }
  REQUIRE(control_group_in("0::/"));
  CHECK(control_group_in("0::/")->group.empty());
  REQUIRE(control_group_in("4:cpuacct,cpu:/a:b/c"));
  CHECK(control_group_in("4:cpuacct,cpu:/a:b/c")->group == "a:b/c");
  CHECK(control_group_in("4:cpuacct,cpu:/a:b/c")->mount == "cpuacct,cpu");
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
