#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "manifests.hpp"
#include "refusal.hpp"
#include "slipfit/core/digest.hpp"

using test::batch;
using test::BatchScene;
using test::check_refused;
using test::files_in;

namespace {

std::vector<std::string> run_shards(const BatchScene& scene, std::size_t count) {
  std::vector<std::string> folders;
  for (std::size_t i = 1; i <= count; ++i) {
    folders.push_back(scene.path("shard" + std::to_string(i)));
    const std::string shard = std::to_string(i) + "/" + std::to_string(count);
    const auto run = batch(scene.manifest(), folders.back(), {"--shard", shard});
    CAPTURE(run.err);
    REQUIRE(run.exit_code <= 1);
  }
  return folders;
}

test::ProgramResult merge(std::vector<std::string> folders, const std::string& out) {
  folders.insert(folders.begin(), "merge");
  folders.insert(folders.end(), {"--out", out});
  return test::run_slipfit(folders);
}

}  // namespace

TEST_CASE("merged shards are the files of one machine, failures included") {
  const BatchScene scene(11);
  std::filesystem::remove(scene.path("r3.csv"));
  std::filesystem::remove(scene.path("r10.csv"));
  REQUIRE(batch(scene.manifest(), scene.path("single")).exit_code == 1);
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{20}}) {
    CAPTURE(count);
    auto folders = run_shards(scene, count);
    std::reverse(folders.begin(), folders.end());
    const auto run = merge(folders, scene.path("merged"));
    CAPTURE(run.err);
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.err, Catch::Contains("2 of 11 recordings failed"));
    CHECK(files_in(scene.path("merged")) == files_in(scene.path("single")));
    for (const std::string& folder : folders) std::filesystem::remove_all(folder);
  }
  const auto record = nlohmann::json::parse(test::content_of(scene.path("merged/run.json")));
  CHECK(record["rows"] == 11);
  CHECK(record["fitted"] == 9);
  CHECK(record["shard"]["count"] == 1);
}

TEST_CASE("a merge of what does not belong together is refused") {
  const BatchScene scene(4);
  const auto shards = run_shards(scene, 2);
  const std::string out = scene.path("merged");
  check_refused({"merge", shards[0], "--out", out}, "shard 2 of the batch");
  check_refused({"merge", shards[0], shards[0], shards[1], "--out", out}, "given before");
  check_refused({"merge", shards[0], shards[1], "--out", shards[1]}, "is one of the shards");
  check_refused({"merge", shards[0], scene.path("none"), "--out", out}, "run.json");
  check_refused({"merge", shards[0], shards[1], "--out", scene.path("none/merged")}, "cannot be written");
  REQUIRE(batch(scene.manifest(), scene.path("other"), {"--shard", "2/2", "--tier", "undamped"}).exit_code == 0);
  check_refused({"merge", shards[0], scene.path("other"), "--out", out}, "belongs to another batch");
  REQUIRE(batch(scene.manifest(), scene.path("third"), {"--shard", "2/3"}).exit_code == 0);
  check_refused({"merge", shards[0], scene.path("third"), "--out", out}, "belongs to another batch");
  check_refused({"merge", shards[0], shards[1], "--out", scene.path("other")}, "results of another batch");
  REQUIRE(merge(shards, out).exit_code == 0);
  CHECK(merge(shards, out).exit_code == 0);  // a merge job that Slurm starts twice
  std::filesystem::remove(shards[1] + "/summary.csv");
  check_refused({"merge", shards[0], shards[1], "--out", out}, "summary.csv: was damaged or changed");
}

TEST_CASE("a shard that is not as it was written is refused") {
  const BatchScene scene(4);
  const auto shards = run_shards(scene, 2);
  const std::string file = shards[0] + "/results.jsonl";
  const std::string written = test::content_of(file);
  const auto lines = test::lines_of(written);
  REQUIRE(lines.size() == 2);
  std::string number = written;
  number[number.find(R"("value":1)") + 8] = '2';
  const std::string other = test::content_of(shards[1] + "/results.jsonl");
  for (const std::string& damaged :
       {written.substr(0, written.size() - 20), lines[1] + "\n" + lines[0] + "\n", number, "[" + written, other}) {
    (void)scene.file("shard1/results.jsonl", damaged);
    check_refused({"merge", shards[0], shards[1], "--out", scene.path("merged")}, "damaged or changed");
  }
  (void)scene.file("shard1/results.jsonl", written);
  (void)scene.file("shard1/summary.csv", test::content_of(shards[0] + "/summary.csv") + "\n");
  check_refused({"merge", shards[0], shards[1], "--out", scene.path("merged")}, "summary.csv: was damaged or changed");
  CHECK_FALSE(std::filesystem::exists(scene.path("merged")));
}

TEST_CASE("a file that grows between two shards stays on its shard") {
  const BatchScene scene(4);
  REQUIRE(batch(scene.manifest(), scene.path("shard1"), {"--shard", "1/2"}).exit_code == 0);
  (void)scene.file("r0.csv", test::content_of(scene.path("r0.csv")) + std::string(500000, '\n'));
  REQUIRE(batch(scene.manifest(), scene.path("shard2"), {"--shard", "2/2"}).exit_code == 0);
  REQUIRE(merge({scene.path("shard1"), scene.path("shard2")}, scene.path("merged")).exit_code == 0);
  const auto lines = test::lines_of(files_in(scene.path("merged")).results);
  REQUIRE(lines.size() == 4);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(nlohmann::json::parse(lines[i])["id"] == "r" + std::to_string(i));
  }
}

TEST_CASE("a shard out of very many is one that may be empty") {
  const BatchScene scene(2);
  CHECK(batch(scene.manifest(), scene.path("first"), {"--shard", "1/1000000000000000000"}).exit_code == 0);
  CHECK(test::lines_of(files_in(scene.path("first")).results).size() == 1);
  CHECK(batch(scene.manifest(), scene.path("last"), {"--shard", "1000000000000000000/1000000000000000000"}).exit_code ==
        0);
  CHECK(files_in(scene.path("last")).results.empty());
  check_refused({"merge", scene.path("first"), scene.path("last"), "--out", scene.path("merged")},
                "shard 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, ... of the batch");
}

TEST_CASE("numbers in run.json that no batch has are refused at once") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto forged = [&](const char* place, const nlohmann::json& value, const std::string& part) {
    auto record = nlohmann::json::parse(test::content_of(scene.path("out/run.json")));
    record[nlohmann::json::json_pointer(place)] = value;
    std::filesystem::create_directory(scene.path("forged"));
    for (const char* const name : {"results.jsonl", "summary.csv", "failures.csv"}) {
      (void)scene.file(std::string("forged/") + name, test::content_of(scene.path(std::string("out/") + name)));
    }
    check_refused({"merge", scene.file("forged/run.json", record.dump()).substr(0, scene.path("forged").size()),
                   "--out", scene.path("merged")},
                  part);
  };
  forged("/shard/count", 1'000'000'000'000'000'000, "shard 2, 3, 4");
  forged("/shard/index", 7, "is shard 7 of 1");
  forged("/shard/index", 0, "is shard 0 of 1");
  forged("/rows", 1'000'000'000'000'000'000, "is in no shard");
  forged("/manifest", std::string(2'000'000, 'x'), "was not written by slipfit batch");
}

TEST_CASE("a result that no fit wrote is not merged") {
  const BatchScene scene(1);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  auto document = nlohmann::json::parse(files_in(scene.path("out")).results);
  document["parameters"]["stiffness_N_per_m"]["se"] = -1;
  const std::string results = scene.file("out/results.jsonl", document.dump() + "\n");
  auto record = nlohmann::json::parse(test::content_of(scene.path("out/run.json")));
  record["digests"]["results"] = slipfit::digest_of(test::content_of(results)).text();
  (void)scene.file("out/run.json", record.dump());
  check_refused({"merge", scene.path("out"), "--out", scene.path("merged")},
                "results.jsonl:1': parameters.stiffness_N_per_m.se is -1");
}
