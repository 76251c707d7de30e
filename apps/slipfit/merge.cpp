#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "slipfit/batch/batch.hpp"

namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
  bool quiet = false;
};

void run(const MergeArguments& arguments) {
  const auto merged = slipfit::merge_batches({arguments.shards.begin(), arguments.shards.end()}, arguments.out);
  if (!merged) throw Failure(ExitCode::WrongUsage, merged.error());
  const slipfit::BatchProgress& progress = merged.value();
  if (progress.failed > 0) {
    throw Failure(
        ExitCode::RecordingsFailed,
        fmt::format("merged into '{}'; {} of {} recordings failed in the shards: the reasons are in its failures.csv",
                    arguments.out, progress.failed, progress.total));
  }
  if (!arguments.quiet) say(fmt::format("merged {} results into '{}'", progress.fitted, arguments.out));
}

}  // namespace

void add_merge_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand("merge", "Merges the shards of a batch into one folder");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("DIR", arguments->shards, "Folders that slipfit batch --shard wrote")->required();
  command->add_option("--out", arguments->out, "Folder of the merged result; created if it does not exist")->required();
  command->add_flag("--quiet", arguments->quiet, "Print only errors on standard error");
  command->callback([arguments] { run(*arguments); });
}
