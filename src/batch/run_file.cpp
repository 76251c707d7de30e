#include "batch/run_file.hpp"

#include <fmt/chrono.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "batch/build.hpp"
#include "batch/files.hpp"
#include "report/json_values.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "slipfit.run/1";
constexpr std::uintmax_t kLargestRecord = std::uintmax_t{1} << 20U;  // hundreds of times what is written

/// Calls `use` with every member of a record and its place in run.json: writing and reading have one list.
template <class Record, class Use>
void for_each_member(Record& record, const Use& use) {
  use("/version", record.version);
  use("/build", record.build);
  use("/processor", record.processor);
  use("/manifest", record.manifest);
  use("/manifest_digest", record.manifest_digest);
  use("/options", record.options);
  use("/shard/index", record.shard.index);
  use("/shard/count", record.shard.count);
  use("/jobs", record.jobs);
  use("/timeout_s", record.timeout_s);
  use("/rows", record.rows);
  use("/total", record.progress.total);
  use("/before", record.progress.before);
  use("/fitted", record.progress.fitted);
  use("/failed", record.progress.failed);
  use("/started", record.started);
  use("/seconds", record.progress.seconds);
  use("/finished", record.finished);
  use("/digests/results", record.digests.results);
  use("/digests/summary", record.digests.summary);
  use("/digests/failures", record.digests.failures);
}

Json options_of(const BatchOptions& options) {
  Json json = options_json({options.fit.tier, options.fit.held});
  json["joint_groups"] = static_cast<bool>(options.fit_group);
  return json;
}

}  // namespace

RunRecord begin_record(const BatchOptions& options, const Digest& manifest_digest, std::size_t rows) {
  RunRecord record;
  record.version = SLIPFIT_VERSION;
  record.build = build_of_program();
  record.processor = processor_of_machine();
  record.manifest = printable(options.manifest.string());
  record.manifest_digest = manifest_digest.text();
  record.options = options_of(options);
  record.shard = options.shard;
  record.jobs = options.jobs;
  record.timeout_s = options.timeout_s;
  record.rows = rows;
  record.started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  return record;
}

std::string processors_of(const RunRecord& a, const RunRecord& b) {
  std::string processors = a.processor;
  std::istringstream others(b.processor);
  for (std::string one; std::getline(others >> std::ws, one, ';');) {
    const std::string known = "; " + processors + ";";
    if (known.find("; " + one + ";") == std::string::npos) processors += "; " + one;
  }
  return processors;
}

void write_record(const std::filesystem::path& folder, const RunRecord& record) {
  Json json;
  json["schema"] = kSchema;
  for_each_member(record, [&](const char* place, const auto& value) { json[Json::json_pointer(place)] = value; });
  replace_file(folder / kRunFile, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<RunRecord> read_record(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kRunFile;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  const auto size = std::filesystem::file_size(file, ignored);
  std::ifstream stream(file, std::ios::binary);
  Json json = !ignored && size <= kLargestRecord ? Json::parse(stream, nullptr, false) : Json();
  try {
    for (const char* const added_later : {"build", "processor"}) json.emplace(added_later, "unknown");
    if (json.at("schema") == kSchema) {
      RunRecord record;
      for_each_member(record,
                      [&](const char* place, auto& value) { json.at(Json::json_pointer(place)).get_to(value); });
      return record;
    }
  } catch (const Json::exception&) {
    // A key is missing or of another kind: no batch wrote the file.
  }
  throw file_error("folder_of_another_batch", file, "was not written by slipfit batch; choose another folder");
}

std::optional<std::string> difference(const RunRecord& before, const RunRecord& now) {
  const auto changed = [](const char* what, const auto& was, const auto& is) {
    return fmt::format("the {} {}, now {}", what, was, is);
  };
  if (before.version != now.version) return changed("version of slipfit was", before.version, "it is " + now.version);
  if (before.build != now.build) return changed("build of slipfit was", before.build, "it is " + now.build);
  if (before.manifest_digest != now.manifest_digest) {
    return fmt::format("the manifest was another one ('{}'), or has been edited since", before.manifest);
  }
  if (before.options != now.options) return changed("options were", before.options.dump(), now.options.dump());
  const auto text_of = [](const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); };
  if (text_of(before.shard) != text_of(now.shard))
    return changed("shard was", text_of(before.shard), text_of(now.shard));
  return std::nullopt;
}

}  // namespace slipfit::batch
