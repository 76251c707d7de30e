#include <catch2/catch.hpp>
#include <filesystem>
#include <iterator>

#include "refusal.hpp"
#include "run_program.hpp"
#include "slipfit/figures/figures.hpp"

using test::check_refused;

TEST_CASE("slipfit figures writes every figure, the same bytes twice, into a folder that it makes") {
  const test::TemporaryFolder folder;
  const std::string target = folder.path("figures");
  for (int run = 0; run < 2; ++run) {
    const test::ProgramResult result = test::run_slipfit({"figures", "--out", target});
    CHECK(result.exit_code == 0);
    CHECK(result.out.empty());
    CHECK(test::lines_in(result.err) == 1);
    const auto files = slipfit::paper_figures();
    const auto written =
        std::distance(std::filesystem::directory_iterator(target), std::filesystem::directory_iterator());
    CHECK(written == static_cast<std::ptrdiff_t>(files.size()));
    for (const slipfit::FigureFile& file : files) CHECK(test::content_of(target + "/" + file.name) == file.content);
  }
  CHECK(test::run_slipfit({"figures", "--out", target, "--quiet"}).err.empty());
}

TEST_CASE("slipfit figures refuses a missing, wrong or unwritable --out in one line") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("file", "kept");
  check_refused({"figures"}, "--out is missing");
  check_refused({"figures", "--out"}, "--out");
  check_refused({"figures", "--out", ""}, "--out");
  check_refused({"figures", "--out", file}, "is a file");
  check_refused({"figures", "--out", file + "/figures"}, "cannot create the folder");
  check_refused({"figures", "--out", folder.path("none/figures")}, "cannot create the folder");
  check_refused({"figures", "extra", "--out", folder.path("x")}, "extra");
  CHECK(test::content_of(file) == "kept");
  CHECK(folder.names() == std::vector<std::string>{"file"});
  // Also for root, who may write anywhere else
  if (std::filesystem::is_directory("/proc/self")) check_refused({"figures", "--out", "/proc/self"}, "cannot write");
}
