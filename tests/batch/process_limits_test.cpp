#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "manifests.hpp"

using Catch::Contains;
using test::batch;
using test::BatchScene;
using test::content_of;
using test::files_in;

namespace {

/// $0 is slipfit, $1 the manifest, $2 the folder.
test::ProgramResult in_shell(const BatchScene& scene, const std::string& script, const std::string& out = "out") {
  return test::run_program("sh", {"-c", script, SLIPFIT_EXECUTABLE, scene.manifest(), scene.path(out)});
}

/// A manifest of r0 and of a pipe that nobody writes.
std::string manifest_with_pipe(const BatchScene& scene) {
  REQUIRE(test::run_program("mkfifo", {scene.path("pipe.csv")}).exit_code == 0);
  return scene.file("runs.csv", "id,file,speed_m_per_s\npipe,pipe.csv,0.02\nr0,r0.csv,0.02\n");
}

}  // namespace

TEST_CASE("where no other process can be started the work is done with fewer, down to none") {
  const BatchScene scene(5);
  REQUIRE(batch(scene.manifest(), scene.path("whole")).exit_code == 0);
  std::filesystem::permissions(scene.path(""), std::filesystem::perms::all);
  for (const std::string limit : {"1", "3", "6"}) {
    CAPTURE(limit);
    const std::string command = "prlimit --nproc=" + limit + " \"$0\" batch \"$1\" --out \"$2\" --jobs 64";
    // The limit does not hold for root.
    const auto run = in_shell(scene,
                              "[ \"$(id -u)\" = 0 ] && exec setpriv --reuid 54321 --regid 54321 --clear-groups " +
                                  command + "; exec " + command,
                              "out" + limit);
    CAPTURE(run.err);
    if (run.exit_code == 126 || run.exit_code == 127) {
      WARN("skipped: another user may not run this program");
      return;
    }
    CHECK(run.exit_code == 0);
    CHECK(files_in(scene.path("out" + limit)) == files_in(scene.path("whole")));
  }
}

TEST_CASE("without --jobs there is one a core that the process may use") {
  const BatchScene scene(1);
  const auto run = in_shell(
      scene, "exec taskset -c \"$(taskset -cp $$ | sed 's/.*: //; s/[,-].*//')\" \"$0\" batch \"$1\" --out \"$2\"");
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(nlohmann::json::parse(content_of(scene.path("out/run.json")))["jobs"] == 1);
}

TEST_CASE("a recording that blocks is failed after --timeout, and the others are fitted") {
  const BatchScene scene(1);
  const auto run = batch(manifest_with_pipe(scene), scene.path("out"), {"--timeout", "500ms"});
  CHECK(run.exit_code == 1);
  CHECK_THAT(files_in(scene.path("out")).failures, Contains("\npipe,timed_out,") && Contains("after 0.5 s"));
  CHECK(test::lines_of(files_in(scene.path("out")).results).size() == 1);
  CHECK(batch(scene.manifest(), scene.path("other"), {"--timeout", "0"}).exit_code == 2);
  CHECK(batch(scene.manifest(), scene.path("other"), {"--timeout", "5 N"}).exit_code == 2);
}

TEST_CASE("a stop ends within two seconds while a recording blocks, and does not count as a try") {
  const BatchScene scene(1);
  const std::string manifest = manifest_with_pipe(scene);
  for (int stop = 0; stop < 4; ++stop) {
    const auto start = std::chrono::steady_clock::now();
    const auto run =
        test::run_program("timeout", {"--foreground", "--preserve-status", "--signal", "TERM", "1", SLIPFIT_EXECUTABLE,
                                      "batch", manifest, "--out", scene.path("out"), "--resume", "--jobs", "2"});
    CAPTURE(run.err);
    CHECK(run.exit_code == 143);
    CHECK_THAT(run.err, Contains("1 of 2 recordings; --resume continues"));
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::milliseconds(3500));  // 1 s, 2 s, and a busy machine
  }
  std::filesystem::remove(scene.path("pipe.csv"));
  std::filesystem::copy(scene.path("r0.csv"), scene.path("pipe.csv"));
  CHECK(batch(manifest, scene.path("out"), {"--resume"}).exit_code == 0);
}

TEST_CASE("with closed standard streams no message runs into a file of the batch") {
  const BatchScene scene(2);
  std::filesystem::remove(scene.path("r1.csv"));
  CHECK(batch(scene.manifest(), scene.path("whole")).exit_code == 1);
  const auto run = in_shell(scene, "exec \"$0\" batch \"$1\" --out \"$2\" <&- >&- 2>&-");
  CHECK(run.exit_code == 1);
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
}
