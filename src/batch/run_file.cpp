#include "batch/run_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "batch/files.hpp"
#include "report/names.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "slipfit.run/1";

std::string utc_now() {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

std::string options_text(const BatchOptions& options) {
  Json fixed = Json::object();
  const HeldParameters& held = options.fit.held;
  const auto put = [&](ParameterId id, const std::optional<double>& value) {
    if (value) fixed[std::string(info(id).key)] = *value;
  };
  put(ParameterId::Stiffness, held.stiffness_N_per_m);
  put(ParameterId::NaturalFrequency, held.natural_frequency_rad_per_s);
  put(ParameterId::DampingRatio, held.damping_ratio);
  return Json{{"tier", options.fit.tier ? std::string(name_of(*options.fit.tier)) : "auto"},
              {"fix", fixed},
              {"joint_groups", static_cast<bool>(options.fit_group)}}
      .dump();
}

std::string shard_text(const Shard& shard) {
  return fmt::format("{}/{}", shard.index, shard.count);
}

Json to_json(const RunRecord& record) {
  const BatchProgress& progress = record.progress;
  return Json{{"schema", kSchema},
              {"version", record.version},
              {"manifest", record.manifest},
              {"manifest_digest", record.manifest_digest},
              {"options", Json::parse(record.options)},
              {"shard", {{"index", record.shard.index}, {"count", record.shard.count}}},
              {"jobs", record.jobs},
              {"timeout_s", record.timeout_s},
              {"rows", record.rows},
              {"total", progress.total},
              {"before", progress.before},
              {"fitted", progress.fitted},
              {"failed", progress.failed},
              {"started", record.started},
              {"seconds", progress.seconds},
              {"finished", record.finished},
              {"digests",
               {{"results", record.digests.results},
                {"summary", record.digests.summary},
                {"failures", record.digests.failures}}}};
}

RunRecord from_json(const Json& json) {
  RunRecord record;
  record.version = json.at("version").get<std::string>();
  record.manifest = json.at("manifest").get<std::string>();
  record.manifest_digest = json.at("manifest_digest").get<std::string>();
  record.options = json.at("options").dump();
  record.shard.index = json.at("shard").at("index").get<std::size_t>();
  record.shard.count = json.at("shard").at("count").get<std::size_t>();
  record.jobs = json.at("jobs").get<std::size_t>();
  record.timeout_s = json.at("timeout_s").get<double>();
  record.rows = json.at("rows").get<std::size_t>();
  record.progress.total = json.at("total").get<std::size_t>();
  record.progress.failed = json.at("failed").get<std::size_t>();
  record.progress.seconds = json.at("seconds").get<double>();
  record.started = json.at("started").get<std::string>();
  record.finished = json.at("finished").get<bool>();
  const Json& digests = json.at("digests");
  record.digests = {digests.at("results").get<std::string>(), digests.at("summary").get<std::string>(),
                    digests.at("failures").get<std::string>()};
  return record;
}

}  // namespace

RunRecord begin_record(const BatchOptions& options, const Digest& manifest_digest, std::size_t rows) {
  RunRecord record;
  record.version = SLIPFIT_VERSION;
  record.manifest = one_line(options.manifest.string());
  record.manifest_digest = manifest_digest.text();
  record.options = options_text(options);
  record.shard = options.shard;
  record.jobs = options.jobs;
  record.timeout_s = options.timeout_s;
  record.rows = rows;
  record.started = utc_now();
  return record;
}

std::optional<Error> write_record(const std::filesystem::path& folder, const RunRecord& record) {
  return replace_file(folder / "run.json", to_json(record).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Result<std::optional<RunRecord>> read_record(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::optional<RunRecord>();
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") == kSchema) return std::optional(from_json(json));
  } catch (const Json::exception&) {
    // falls through: not one of ours
  }
  return Error{"folder_of_another_batch",
               one_line(file.string()) + ": was not written by slipfit batch; choose another folder"};
}

std::optional<std::string> difference(const RunRecord& before, const RunRecord& now) {
  if (before.version != now.version) {
    return fmt::format("the version of slipfit was {}, now it is {}", before.version, now.version);
  }
  if (before.manifest_digest != now.manifest_digest) {
    return fmt::format("the manifest was another one ('{}'), or has been edited since", before.manifest);
  }
  if (before.options != now.options) return fmt::format("the options were {}, now {}", before.options, now.options);
  if (before.shard.index != now.shard.index || before.shard.count != now.shard.count) {
    return fmt::format("the shard was {}, now {}", shard_text(before.shard), shard_text(now.shard));
  }
  return std::nullopt;
}

}  // namespace slipfit::batch
