// Simulates recordings and sweeps of known truth, fits them, and prints truth and estimate of each parameter, for
// coverage/summarise.py.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "families.hpp"
#include "in_parallel.hpp"
#include "rows.hpp"

namespace {

struct Arguments {
  std::vector<std::string> families = coverage::family_names();
  std::uint64_t count = 100;
  std::uint64_t seed = 1;
  unsigned jobs = 2;
};

std::vector<coverage::Row> run(const Arguments& arguments) {
  const std::size_t total = arguments.count * arguments.families.size();
  const auto results = in_parallel(total, arguments.jobs, [&](std::size_t i) {
    const std::string& family = arguments.families[i / arguments.count];
    const std::uint64_t index = i % arguments.count;
    return family == "sweeps" ? coverage::fit_joint(coverage::make_sweep(arguments.seed + index))
                              : coverage::fit_scene(coverage::make_scene(family, index, arguments.seed));
  });
  std::vector<coverage::Row> rows;
  for (const auto& result : results) rows.insert(rows.end(), result.begin(), result.end());
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App program("Coverage of the 95 % intervals over simulated recordings and sweeps");
  program
      .add_option("--families", arguments.families, "Comma-separated; default: all of recordings. Speed sweeps: sweeps")
      ->delimiter(',');
  program.add_option("--count", arguments.count, "Recordings or sweeps of each family")->capture_default_str();
  program.add_option("--seed", arguments.seed)->capture_default_str();
  program.add_option("--jobs", arguments.jobs, "Threads")->capture_default_str();
  CLI11_PARSE(program, argc, argv);
  fmt::print("{}", coverage::to_csv(run(arguments)));
}
