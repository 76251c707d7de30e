#include "refusal.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "manifests.hpp"

using test::batch;
using test::BatchScene;
using test::check_refused;

namespace {

void check_refused_batch(const BatchScene& scene, const std::string& manifest, const std::vector<std::string>& more,
                         const std::string& part) {
  std::vector<std::string> arguments{"batch", manifest, "--out", scene.path("refused")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  check_refused(arguments, part);
}

}  // namespace

TEST_CASE("options of a batch that make no sense are refused") {
  const BatchScene scene(1);
  check_refused({"batch"}, "MANIFEST");
  check_refused({"batch", scene.manifest()}, "--out");
  for (const std::string shard : {"0/2", "3/2", "1", "1/", "/2", "1/0", "-1/2", "1/2x", "a/b"}) {
    check_refused_batch(scene, scene.manifest(), {"--shard", shard}, "expected I/N");
  }
  check_refused_batch(scene, scene.manifest(), {"--jobs", "-1"}, "--jobs");
  check_refused_batch(scene, scene.manifest(), {"--jobs", "many"}, "--jobs");
  check_refused_batch(scene, scene.manifest(), {"--tier", "cubic"}, "--tier");
  check_refused_batch(scene, scene.manifest(), {"--fix", "x=1"}, "--fix");
  check_refused({"merge", "--out", scene.path("refused")}, "DIR");
  check_refused({"merge", scene.path("none")}, "--out");
  CHECK_FALSE(std::filesystem::exists(scene.path("refused")));
}

TEST_CASE("a manifest with any fault is refused before anything is done") {
  const BatchScene scene(2);
  const std::string twice = "id,file,speed_m_per_s\nr0,r0.csv,0.02\nr0,r1.csv,0.02\n";
  check_refused_batch(scene, scene.file("bad.csv", twice), {}, "bad.csv:3: column 'id': 'r0' is also in line 2");
  check_refused_batch(scene, scene.file("none.csv", ""), {}, "empty");
  check_refused_batch(scene, scene.path("absent.csv"), {}, "no such file");
  check_refused_batch(scene, scene.path(""), {"--quiet"}, "no recording has a speed in a column or in its name");
  CHECK_FALSE(std::filesystem::exists(scene.path("refused")));
}

TEST_CASE("a batch never writes over its manifest or a recording") {
  const BatchScene scene(1);
  for (const std::string name : {"summary.csv", "run.json", "failures.csv", "results.jsonl"}) {
    const std::string content = "id,file,speed_m_per_s\nr0,r0.csv,0.02\n";
    const std::string manifest = scene.file(name, content);
    check_refused({"batch", manifest, "--out", scene.path("")}, name);
    CHECK(test::content_of(manifest) == content);
    std::filesystem::remove(manifest);
  }
  std::filesystem::copy(scene.path("r0.csv"), scene.path("summary.csv"));
  const std::string manifest = scene.file("other.csv", "id,file,speed_m_per_s\nr0,summary.csv,0.02\n");
  check_refused({"batch", manifest, "--out", scene.path("")}, "summary.csv");
  CHECK(test::content_of(scene.path("summary.csv")) == test::content_of(scene.path("r0.csv")));
}

TEST_CASE("a folder that cannot be written is one line and exit code 2") {
  const BatchScene scene(1);
  check_refused({"batch", scene.manifest(), "--out", scene.path("none/out")}, "the folder cannot be written");
  check_refused({"batch", scene.manifest(), "--out", scene.path("r0.csv")}, "cannot be written");
  std::filesystem::create_directory(scene.path("out"));
  std::filesystem::permissions(scene.path("out"), std::filesystem::perms::owner_read);
  if (std::ofstream(scene.path("out/x")).good()) {
    WARN("read-only folder skipped: this user (root) may write everywhere; /proc stands in for it");
    check_refused({"batch", scene.manifest(), "--out", "/proc/slipfit"}, "cannot be written");
    return;
  }
  check_refused({"batch", scene.manifest(), "--out", scene.path("out")}, "cannot be written");
}

TEST_CASE("a full disk ends a batch with one line, and the folder can be gone on with") {
  const BatchScene scene(6);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  // A limit on the size of files fills up in the middle of a line, like a disk.
  const std::string limited = "trap '' XFSZ; ulimit -f 24; exec \"$0\" batch \"$1\" --out \"$2\" --jobs 2";
  const auto run = test::run_program("sh", {"-c", limited, SLIPFIT_EXECUTABLE, scene.manifest(), scene.path("small")});
  CAPTURE(run.err);
  CHECK(run.exit_code == 2);
  CHECK(test::lines_in(run.err) == 1);
  CHECK_THAT(run.err, Catch::Contains("journal: cannot be written") && Catch::Contains("--resume"));
  CHECK(test::content_of(scene.path("small/journal")).back() != '\n');
  for (const auto& entry : std::filesystem::directory_iterator(scene.path("small"))) {
    CHECK_THAT(entry.path().filename().string(), !Catch::EndsWith(".new"));
  }
  CHECK(batch(scene.manifest(), scene.path("small"), {"--resume"}).exit_code == 0);
  CHECK(test::files_in(scene.path("small")) == test::files_in(scene.path("out")));
}

TEST_CASE("the folder of another batch is refused, and --resume states the reason") {
  const BatchScene scene(2);
  const std::string out = scene.path("out");
  REQUIRE(batch(scene.manifest(), out).exit_code == 0);
  const auto before = test::files_in(out);
  const std::string other = scene.file("other.csv", "id,file,speed_m_per_s\nr0,r0.csv,0.02\n");
  check_refused({"batch", scene.manifest(), "--out", out}, "--resume");
  check_refused({"batch", other, "--out", out, "--resume"}, "the manifest was another one");
  check_refused({"batch", other, "--out", out}, "the manifest was another one");
  check_refused({"batch", scene.manifest(), "--out", out, "--resume", "--tier", "undamped"}, "the options were");
  check_refused({"batch", scene.manifest(), "--out", out, "--resume", "--shard", "1/2"}, "the shard was 1/1, now 1/2");
  std::string record = test::content_of(out + "/run.json");
  const std::string version = nlohmann::json::parse(record)["version"];
  record.replace(record.find(version), version.size(), "0.0.1");
  (void)scene.file("out/run.json", record);
  check_refused({"batch", scene.manifest(), "--out", out, "--resume"}, "the version of slipfit was 0.0.1");
  record.replace(record.find("0.0.1"), 5, version);
  auto other_build = nlohmann::ordered_json::parse(record);
  other_build["build"] = "of another compiler";
  (void)scene.file("out/run.json", other_build.dump());
  check_refused({"batch", scene.manifest(), "--out", out, "--resume"},
                "the build of slipfit was of another compiler, now ");
  other_build.erase("build");
  (void)scene.file("out/run.json", other_build.dump());
  check_refused({"batch", scene.manifest(), "--out", out, "--resume"}, "the build of slipfit was unknown, now ");
  (void)scene.file("out/run.json", "{\"x\": 1}");
  check_refused({"batch", scene.manifest(), "--out", out, "--resume"}, "not written by slipfit");
  std::filesystem::remove(out + "/run.json");
  check_refused({"batch", scene.manifest(), "--out", out, "--resume"}, "without the run.json");
  CHECK(test::files_in(out) == before);
}

TEST_CASE("files of the names of a batch that no batch wrote stay as they are") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("shard"), {"--shard", "1/1"}).exit_code == 0);
  for (const std::string name : {"results.jsonl", "summary.csv", "failures.csv", "run.json", "journal", "lock"}) {
    CAPTURE(name);
    const test::TemporaryFolder own;
    const std::string content = "my own, for years\n";
    (void)own.file(name, content);
    for (const std::string option : {"--quiet", "--resume"}) {
      check_refused({"batch", scene.manifest(), "--out", own.path(""), option}, "choose another");
    }
    check_refused({"merge", scene.path("shard"), "--out", own.path("")}, "choose another");
    CHECK(own.names() == std::vector<std::string>{name});
    CHECK(test::content_of(own.path(name)) == content);
  }
}

TEST_CASE("symbolic links in the folder of a batch are not followed") {
  const BatchScene scene(2);
  const std::string victim = scene.file("victim", "precious\n");
  for (const std::string name : {"results.jsonl", "summary.csv", "failures.csv", "run.json", "journal", "lock"}) {
    CAPTURE(name);
    const test::TemporaryFolder own;
    std::filesystem::create_symlink(victim, own.path(name));
    check_refused({"batch", scene.manifest(), "--out", own.path("")}, "symbolic link");
    CHECK(test::content_of(victim) == "precious\n");
    CHECK(own.names() == std::vector<std::string>{name});
  }
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  std::filesystem::remove(scene.path("out/failures.csv"));
  std::filesystem::create_symlink(victim, scene.path("out/failures.csv"));
  check_refused({"batch", scene.manifest(), "--out", scene.path("out"), "--resume"}, "symbolic link");
  CHECK(test::content_of(victim) == "precious\n");
}

TEST_CASE("a manifest that is a pipe is refused and not waited for") {
  const BatchScene scene(1);
  REQUIRE(test::run_program("mkfifo", {scene.path("pipe")}).exit_code == 0);
  check_refused({"batch", scene.path("pipe"), "--out", scene.path("out")}, "not a regular file");
}
