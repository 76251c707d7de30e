// Simulates recordings of known truth, fits them, and counts how often the truth lies in the intervals.
// docs/validation.md quotes what it prints.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "families.hpp"
#include "tally.hpp"

namespace {

struct Arguments {
  std::vector<std::string> families = coverage::family_names();
  std::uint64_t count = 100;
  std::uint64_t seed = 1;
  unsigned jobs = 2;
  std::string out;
};

/// Rows in the order of families and recordings, whatever the number of threads.
std::vector<coverage::Row> run(const Arguments& arguments) {
  const std::uint64_t total = arguments.count * arguments.families.size();
  std::vector<std::vector<coverage::Row>> results(total);
  std::atomic<std::uint64_t> next{0};
  const auto work = [&] {
    for (std::uint64_t i = next++; i < total; i = next++) {
      const std::string& family = arguments.families[i / arguments.count];
      results[i] = coverage::fit_scene(coverage::make_scene(family, i % arguments.count, arguments.seed));
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, arguments.jobs); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::vector<coverage::Row> rows;
  for (const auto& result : results) rows.insert(rows.end(), result.begin(), result.end());
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App program("Coverage of the 95 % intervals over simulated recordings");
  program.add_option("--families", arguments.families, "Comma-separated; default: all")->delimiter(',');
  program.add_option("--count", arguments.count, "Recordings of each family")->capture_default_str();
  program.add_option("--seed", arguments.seed)->capture_default_str();
  program.add_option("--jobs", arguments.jobs, "Threads")->capture_default_str();
  program.add_option("--out", arguments.out, "Write one row a recording and parameter (CSV)");
  CLI11_PARSE(program, argc, argv);
  const std::vector<coverage::Row> rows = run(arguments);
  if (!arguments.out.empty()) std::ofstream(arguments.out) << coverage::to_csv(rows);
  fmt::print("{}", coverage::summarise(rows));
}
