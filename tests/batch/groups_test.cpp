#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "manifests.hpp"
#include "slipfit/batch/batch.hpp"

using slipfit::BatchFit;
using slipfit::BatchOptions;
using slipfit::ManifestEntry;
using slipfit::Result;
using test::BatchScene;
using test::files_in;
using test::lines_of;

namespace {

/// Stands in for a fit of a sweep: a document that lists the members.
Result<BatchFit> list_members(const std::string& id, const std::vector<ManifestEntry>& members) {
  nlohmann::ordered_json document{
      {"schema", "slipfit.fit/1"}, {"id", id}, {"status", "stick_slip"}, {"members", nlohmann::json::array()}};
  for (const ManifestEntry& member : members) document["members"].push_back(member.id);
  return BatchFit{document.dump(), {}, {}};
}

BatchOptions options_for(const BatchScene& scene, const std::string& out) {
  BatchOptions options;
  options.manifest = scene.manifest();
  options.folder = scene.path(out);
  options.jobs = 2;
  options.fit_group = list_members;
  return options;
}

void run_ok(const BatchOptions& options, std::size_t failed = 0) {
  const auto outcome = slipfit::run_batch(options);
  INFO((outcome.ok() ? std::string() : outcome.error().message));
  REQUIRE(outcome.ok());
  CHECK(outcome.value().progress.failed == failed);
}

std::vector<std::string> ids_in(const std::string& folder) {
  std::vector<std::string> ids;
  for (const std::string& line : lines_of(files_in(folder).results)) ids.push_back(nlohmann::json::parse(line)["id"]);
  return ids;
}

}  // namespace

TEST_CASE("the result of a group follows its last recording, with all its members") {
  const BatchScene scene(8);  // g0: 0 3 6, g1: 1 4 7
  run_ok(options_for(scene, "out"));
  CHECK(ids_in(scene.path("out")) ==
        std::vector<std::string>{"r0", "r1", "r2", "r3", "r4", "r5", "r6", "group:g0", "r7", "group:g1"});
  const auto lines = lines_of(files_in(scene.path("out")).results);
  CHECK(nlohmann::json::parse(lines[7])["members"] == nlohmann::json({"r0", "r3", "r6"}));
  CHECK(nlohmann::json::parse(lines[9])["members"] == nlohmann::json({"r1", "r4", "r7"}));
  const auto summary = lines_of(files_in(scene.path("out")).summary);
  CHECK_THAT(summary[8], Catch::StartsWith("7,group:g0,g0,,stick_slip,"));
}

TEST_CASE("a group stays on one shard, and merged shards are the files of one machine") {
  const BatchScene scene(9);
  run_ok(options_for(scene, "single"));
  std::vector<std::filesystem::path> shards;
  for (std::size_t i = 1; i <= 3; ++i) {
    BatchOptions options = options_for(scene, "shard" + std::to_string(i));
    options.shard = {i, 3};
    run_ok(options);
    shards.push_back(options.folder);
  }
  const auto merged = slipfit::merge_batches(shards, scene.path("merged"));
  INFO((merged.ok() ? std::string() : merged.error().message));
  REQUIRE(merged.ok());
  CHECK(merged.value().total == 11);
  CHECK(files_in(scene.path("merged")) == files_in(scene.path("single")));
}

TEST_CASE("a group that fails is a row of failures.csv under its id, and is tried again") {
  const BatchScene scene(6);
  BatchOptions options = options_for(scene, "out");
  options.fit_group = [](const std::string& id, const std::vector<ManifestEntry>& members) -> Result<BatchFit> {
    if (id == "group:g1") return slipfit::Error{"too_few_recordings", "one speed only"};
    return list_members(id, members);
  };
  run_ok(options, 1);
  CHECK_THAT(files_in(scene.path("out")).failures, Catch::EndsWith("\ngroup:g1,too_few_recordings,one speed only\n"));
  options.fit_group = list_members;
  options.resume = true;
  run_ok(options);
  run_ok(options_for(scene, "whole"));
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
}

TEST_CASE("a fit that throws is that recording's failure, and does not end the batch") {
  const BatchScene scene(3);
  const auto [is_exception, code] =
      GENERATE(table<bool, std::string>({{true, "out_of_memory"}, {false, "internal_error"}}));
  BatchOptions options = options_for(scene, "out");
  options.fit_group = [is_exception = is_exception](const std::string&,
                                                    const std::vector<ManifestEntry>&) -> Result<BatchFit> {
    if (is_exception) throw std::bad_alloc();
    throw 1;
  };
  run_ok(options, 2);
  CHECK_THAT(files_in(scene.path("out")).failures, Catch::Contains("group:g0," + code + ","));
}

TEST_CASE("a fit that ends its process is tried three times, and touches no other") {
  const BatchScene scene(6);
  BatchOptions options = options_for(scene, "out");
  options.fit_group = [&scene](const std::string& id, const std::vector<ManifestEntry>& members) -> Result<BatchFit> {
    if (id != "group:g1") return list_members(id, members);
    std::ofstream(scene.path("tries"), std::ios::app) << "x";
    (void)std::raise(SIGKILL);
    return list_members(id, members);
  };
  run_ok(options, 1);
  CHECK(test::content_of(scene.path("tries")) == "xxx");
  CHECK(ids_in(scene.path("out")).size() == 7);
  CHECK_THAT(files_in(scene.path("out")).failures,
             Catch::Contains("\ngroup:g1,crashed,") && Catch::Contains("3 times (signal 9, Killed)"));
}

TEST_CASE("a fit that takes longer than the timeout has failed, and a group has the time of its members") {
  const BatchScene scene(6);  // g0: 0 3, g1: 1 4
  BatchOptions options = options_for(scene, "out");
  options.timeout_s = 1.0;
  options.fit_group = [](const std::string& id, const std::vector<ManifestEntry>& members) {
    ::usleep(id == "group:g1" ? 20'000'000 : 1'300'000);
    return list_members(id, members);
  };
  const auto start = std::chrono::steady_clock::now();
  run_ok(options, 1);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(15));
  CHECK_THAT(files_in(scene.path("out")).failures,
             Catch::Contains("\ngroup:g1,timed_out,") && Catch::Contains("after 2 s"));
  CHECK(ids_in(scene.path("out")).size() == 7);
}

TEST_CASE("a batch that is stopped finishes running fits and can be continued") {
  const BatchScene scene(8);
  BatchOptions options = options_for(scene, "out");
  options.fit_group = [&scene](const std::string& id, const std::vector<ManifestEntry>& members) {
    (void)scene.file("stop", "");  // it runs in another process
    return list_members(id, members);
  };
  slipfit::BatchHooks hooks;
  hooks.should_stop = [&scene] { return std::filesystem::exists(scene.path("stop")); };
  const auto stopped = slipfit::run_batch(options, hooks);
  REQUIRE(stopped.ok());
  CHECK(stopped.value().end == slipfit::BatchEnd::Stopped);
  const auto events = lines_of(test::content_of(scene.path("out/journal")));
  CHECK(std::count_if(events.begin(), events.end(),
                      [](const std::string& event) { return event.find(" fit ") == event.find(' '); }) >= 9);
  options.resume = true;
  options.fit_group = list_members;
  run_ok(options);
  run_ok(options_for(scene, "whole"));
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
}

TEST_CASE("a manifest that is edited while the batch runs is noticed") {
  const BatchScene scene(4);
  BatchOptions options = options_for(scene, "out");
  options.fit_group = [&scene](const std::string& id, const std::vector<ManifestEntry>& members) {
    (void)scene.file("runs.csv", "id,file,speed_m_per_s,group\nr0,r1.csv,0.02,g0\n");
    return list_members(id, members);
  };
  const auto outcome = slipfit::run_batch(options);
  REQUIRE_FALSE(outcome.ok());
  CHECK(outcome.error().code == "manifest_changed");
}
