#include <catch2/catch.hpp>
#include <cmath>
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
  CHECK(line(scene.path("out"), 1)["recording"]["input_bytes"] == bytes.size());
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
  CHECK_THAT(run.err, Contains("2 results belonged"));
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

namespace {

/// A profile with a ridge every 40 um.
std::string profile(double ridge_m) {
  std::string text = "x [m];z [m]\n";
  for (int i = 0; i < 4000; ++i) {
    const double x = 1e-6 * i;
    text += std::to_string(1e6 * x) + "e-6;" + std::to_string(std::sin(6.283185307 * x / ridge_m)) + "e-6\n";
  }
  return text;
}

}  // namespace

TEST_CASE(
    "a document lists the surface that was read with its digest, and another surface is read when the batch is "
    "resumed") {
  const BatchScene scene(2);
  (void)scene.file("track.csv", profile(40e-6));
  const std::string manifest =
      scene.file("worn.csv", "id,file,speed_m_per_s,group,surface\nr0,r0.csv,0.02,g,\nr1,r1.csv,0.02,g,track.csv\n");
  const std::string out = scene.path("out");
  REQUIRE(batch(manifest, out, {"--joint-groups"}).exit_code == 0);
  const auto input = line(out, 1)["recording"]["other_inputs"].at(0);
  const std::string bytes = content_of(scene.path("track.csv"));
  CHECK_THAT(input["file"].get<std::string>(), Catch::EndsWith("track.csv"));
  CHECK(input["input_digest"] == slipfit::digest_of(bytes).text());
  CHECK(input["input_bytes"] == bytes.size());
  CHECK_FALSE(line(out, 0)["recording"].contains("other_inputs"));

  REQUIRE(batch(manifest, out, {"--joint-groups", "--resume"}).exit_code == 0);
  CHECK(nlohmann::json::parse(content_of(out + "/run.json"))["fitted"] == 0);

  (void)scene.file("track.csv", profile(80e-6));
  const auto run = batch(manifest, out, {"--joint-groups", "--resume"});
  CHECK_THAT(run.err, Contains("2 results belonged") && Contains("fitted again ('r1' first)"));
  REQUIRE(batch(manifest, scene.path("afresh"), {"--joint-groups"}).exit_code == 0);
  CHECK(files_in(out) == files_in(scene.path("afresh")));

  fs::remove(scene.path("track.csv"));
  CHECK_THAT(batch(manifest, out, {"--resume", "--joint-groups"}).err, Contains("cannot be read now"));
  CHECK(files_in(out) == files_in(scene.path("afresh")));
}
