#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "manifests.hpp"
#include "slipfit/core/digest.hpp"

using Catch::Contains;
using test::batch;
using test::BatchScene;
using test::content_of;
using test::files_in;

namespace fs = std::filesystem;

namespace {

nlohmann::json line(const std::string& folder, std::size_t number) {
  return nlohmann::json::parse(test::lines_of(files_in(folder).results).at(number));
}

}  // namespace

TEST_CASE("a document has the digest and the number of the bytes that were parsed") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  for (const std::size_t i : {0U, 1U}) {
    const std::string bytes = content_of(scene.path("r" + std::to_string(i) + ".csv"));
    const auto recording = line(scene.path("out"), i)["recording"];
    CHECK(recording["input_digest"] == slipfit::digest_of(bytes).text());
    CHECK(recording["input_bytes"] == bytes.size());
  }
}

TEST_CASE("a recording that was replaced after its fit is fitted again when the batch is resumed, and that is said") {
  const BatchScene scene(3);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto before = files_in(scene.path("out"));
  std::string bytes = content_of(scene.path("r1.csv"));
  bytes[bytes.size() - 2] = bytes[bytes.size() - 2] == '1' ? '2' : '1';  // of the same size
  (void)scene.file("r1.csv", bytes);
  const auto run = batch(scene.manifest(), scene.path("out"), {"--resume"});
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("fitted again ('r1' first)"));
  CHECK(line(scene.path("out"), 1)["recording"]["input_digest"] == slipfit::digest_of(bytes).text());
  const auto record = nlohmann::json::parse(content_of(scene.path("out/run.json")));
  CHECK(record["before"] == 2);
  CHECK(record["fitted"] == 1);
  REQUIRE(batch(scene.manifest(), scene.path("afresh")).exit_code == 0);
  CHECK(files_in(scene.path("out")) == files_in(scene.path("afresh")));
  CHECK_FALSE(files_in(scene.path("out")) == before);
}

TEST_CASE("a group is fitted again when one of its recordings was replaced") {
  const BatchScene scene(6);
  (void)batch(scene.manifest(), scene.path("out"), {"--joint-groups"});
  fs::copy_file(scene.path("r4.csv"), scene.path("r3.csv"), fs::copy_options::overwrite_existing);
  const auto run = batch(scene.manifest(), scene.path("out"), {"--joint-groups", "--resume"});
  CHECK_THAT(run.err, Contains("2 of the results"));
  (void)batch(scene.manifest(), scene.path("afresh"), {"--joint-groups"});
  CHECK(files_in(scene.path("out")) == files_in(scene.path("afresh")));
}

TEST_CASE("the result of a recording that cannot be read any more is kept, and that is said") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto before = files_in(scene.path("out"));
  fs::remove(scene.path("r0.csv"));
  const auto run = batch(scene.manifest(), scene.path("out"), {"--resume"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("cannot be read now") && Contains("'r0'"));
  CHECK(files_in(scene.path("out")) == before);
}
