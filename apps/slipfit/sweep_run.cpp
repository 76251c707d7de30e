#include "sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "failure.hpp"
#include "progress_line.hpp"
#include "slipfit/background.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"

using slipfit::ManifestEntry;

std::vector<ManifestEntry> manifest_entries(const std::string& manifest, const std::optional<std::string>& group,
                                            const std::vector<std::string>& only) {
  const std::vector<ManifestEntry> entries = value_or_fail(slipfit::read_manifest_group(manifest, group));
  if (only.empty()) return entries;
  std::vector<ManifestEntry> chosen;
  for (const std::string& id : only) {
    const auto entry = std::ranges::find(entries, id, &ManifestEntry::id);
    if (entry == entries.end()) {
      refuse("{}: no recording '{}'{}, named by --only", manifest, id, group ? " in group '" + *group + "'" : "");
    }
    chosen.push_back(*entry);
  }
  return chosen;
}

namespace {

std::vector<slipfit::SweepEntry> read_recordings(const std::vector<ManifestEntry>& manifest) {
  auto entries = slipfit::read_sweep(manifest);
  if (entries) return std::move(entries).value();
  const bool manifest_asks_for_it = entries.error().code == "view_not_spring";
  throw Failure(manifest_asks_for_it ? ExitCode::WrongUsage : ExitCode::BadRecording, entries.error());
}

}  // namespace

slipfit::SweepAnalysis analyze_with_progress(const std::vector<slipfit::SweepEntry>& entries,
                                             slipfit::FitOptions options, const DocumentOptions& document) {
  ProgressLine line;
  options.curve = document.has("--report");
  if (!document.quiet) options.notify_step = [&line](const std::string& step) { line.show(step); };
  return slipfit::analyze_sweep(entries, options);
}

void run_sweep(const SweepArguments& arguments, const slipfit::FitOptions& options) {
  const std::vector<OutputFile>& outputs = arguments.document.outputs;
  check_outputs(outputs, arguments.manifest);
  for (const ManifestEntry& entry : arguments.entries) check_outputs(outputs, entry.file.string());
  const std::vector<slipfit::SweepEntry> entries = read_recordings(arguments.entries);
  write_sweep(arguments.name, arguments.document, entries, analyze_with_progress(entries, options, arguments.document));
}

void write_sweep(const std::string& name, const DocumentOptions& document,
                 const std::vector<slipfit::SweepEntry>& entries, const slipfit::SweepAnalysis& sweep) {
  write_results(document, [&](const std::string& option) {
    if (option == "--report") {
      return to_html(entries, sweep, predict_around(entries, sweep), {name, document.command_line});
    }
    if (document.json) return slipfit::to_json(entries, sweep, {.id = name}) + "\n";
    return document.details ? slipfit::to_text(entries, sweep, name) : slipfit::to_summary(entries, sweep, name);
  });
}
