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
  auto entries = slipfit::read_manifest_group(manifest, group);
  if (!entries) throw Failure(ExitCode::WrongUsage, entries.error());
  std::vector<ManifestEntry> chosen;
  for (const std::string& id : only) {
    const auto entry = std::find_if(entries.value().begin(), entries.value().end(),
                                    [&id](const ManifestEntry& candidate) { return candidate.id == id; });
    if (entry == entries.value().end()) {
      throw Failure(ExitCode::WrongUsage, fmt::format("{}: no recording '{}'{}, named by --only", manifest, id,
                                                      group ? " in group '" + *group + "'" : ""));
    }
    chosen.push_back(*entry);
  }
  return only.empty() ? std::move(entries).value() : chosen;
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
  const std::vector<OutputFile>& outputs = arguments.document.options.outputs;
  check_outputs(outputs, arguments.manifest);
  for (const ManifestEntry& entry : arguments.entries) check_outputs(outputs, entry.file.string());
  const std::vector<slipfit::SweepEntry> entries = read_recordings(arguments.entries);
  write_sweep(arguments.document, entries, analyze_with_progress(entries, options, arguments.document.options));
}

void write_sweep(const SweepDocument& document, const std::vector<slipfit::SweepEntry>& entries,
                 const slipfit::SweepAnalysis& sweep) {
  slipfit::JsonOptions layout;
  layout.id = document.name;
  write_results(document.options, [&](const std::string& option) {
    if (option == "--report") {
      return to_html(entries, sweep, predict_around(entries, sweep), {layout.id, document.command_line});
    }
    if (document.options.json) return slipfit::to_json(entries, sweep, layout) + "\n";
    return document.options.details ? slipfit::to_text(entries, sweep, layout.id)
                                    : slipfit::to_summary(entries, sweep, layout.id);
  });
}
