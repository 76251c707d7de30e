#include <fmt/format.h>

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
  DocumentOptions messages;
};

void add_options(CLI::App& command, MergeArguments& arguments) {
  command.add_option("DIR", arguments.shards, "Folders that slipfit batch --shard wrote")->required();
  command.add_option("--out", arguments.out, "Folder of the merged result; created if it does not exist")->required();
  add_quiet_option(command, arguments.messages);
}

void run(const MergeArguments& arguments) {
  const slipfit::BatchProgress progress =
      value_or_fail(slipfit::merge_batches({arguments.shards.begin(), arguments.shards.end()}, arguments.out));
  if (progress.failed > 0) {
    throw Failure(
        ExitCode::RecordingsFailed,
        fmt::format("merged into '{}'; {} of {} recordings failed in the shards: the reasons are in its failures.csv",
                    arguments.out, progress.failed, progress.total));
  }
  arguments.messages.notify(fmt::format("merged {} results into '{}'", progress.fitted, arguments.out));
}

}  // namespace

void add_merge_command(CLI::App& program, const std::string& /*typed_line*/) {
  add_command<MergeArguments>(program, "merge", "Merges the shards of a batch into one folder", add_options, run);
}
