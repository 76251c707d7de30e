#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "manifests.hpp"
#include "refusal.hpp"
#include "slipfit/core/digest.hpp"

using test::batch;
using test::BatchScene;
using test::check_refused;
using test::content_of;
using test::files_in;
using test::lines_of;

namespace {

/// An event as a journal has it.
std::string event(const std::string& text) {
  return slipfit::digest_of(text).text() + " " + text + "\n";
}

/// What the journal of an unfinished batch holds for each of its documents.
std::vector<std::string> events_of(const std::vector<std::string>& documents) {
  std::vector<std::string> events;
  for (std::size_t slot = 0; slot < documents.size(); ++slot) {
    const std::string place = std::to_string(slot);
    events.push_back(event("begin " + place) + event("fit " + place + " " + documents[slot]));
  }
  return events;
}

std::size_t fits_in(const std::string& journal) {
  const auto lines = lines_of(journal);
  return static_cast<std::size_t>(std::count_if(
      lines.begin(), lines.end(), [](const std::string& line) { return line.find(" fit ") == line.find(' '); }));
}

/// A finished batch, and what a kill would leave of it.
class Interrupted {
 public:
  explicit Interrupted(std::size_t recordings) : scene_(recordings) {
    REQUIRE(batch(scene_.manifest(), scene_.path("out")).exit_code == 0);
    whole_ = files_in(scene_.path("out"));
  }

  /// Goes on from these bytes of the journal, and demands the files of the whole run.
  void check_resumed_from(const std::string& journal) const {
    auto unfinished = nlohmann::ordered_json::parse(content_of(scene_.path("out/run.json")));
    unfinished["finished"] = false;
    (void)scene_.file("out/run.json", unfinished.dump());
    (void)scene_.file("out/journal", journal);
    std::filesystem::remove(scene_.path("out/summary.csv"));
    (void)scene_.file("out/results.jsonl", "of an earlier time");
    (void)scene_.file("out/failures.csv", "id,co");
    (void)scene_.file("out/lock", "slipfit batch, process 1 on nowhere");
    (void)scene_.file("out/.results.jsonl.new", "left over");
    const auto run = batch(scene_.manifest(), scene_.path("out"), {"--resume", "--jobs", "2"});
    CAPTURE(run.err, journal.size());
    CHECK(run.exit_code == 0);
    CHECK(files_in(scene_.path("out")) == whole_);
    CHECK_FALSE(std::filesystem::exists(scene_.path("out/.results.jsonl.new")));
    CHECK_FALSE(std::filesystem::exists(scene_.path("out/journal")));
    CHECK_FALSE(std::filesystem::exists(scene_.path("out/lock")));
  }

  /// The events of each recording.
  [[nodiscard]] std::vector<std::string> events() const { return events_of(lines_of(whole_.results)); }
  [[nodiscard]] nlohmann::json record() const { return nlohmann::json::parse(content_of(scene_.path("out/run.json"))); }

 private:
  BatchScene scene_;
  test::BatchFiles whole_;
};

/// A manifest that keeps a batch busy for some seconds: the same recordings over and over.
std::string long_manifest(const BatchScene& scene) {
  std::string rows = "id,file,speed_m_per_s\n";
  for (int i = 0; i < 5000; ++i) rows += "x" + std::to_string(i) + ",r" + std::to_string(i % 5) + ".csv,0.02\n";
  return scene.file("long.csv", rows);
}

}  // namespace

TEST_CASE("a batch that was interrupted at any byte continues to the same files") {
  const Interrupted run(5);
  std::string journal;
  for (const std::string& events : run.events()) journal += events;
  const std::size_t first_line = journal.find('\n') + 1;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, first_line - 1, first_line, first_line + 1,
                                 journal.size() / 2, journal.size() - 1, journal.size()}) {
    run.check_resumed_from(journal.substr(0, size));
  }
}

TEST_CASE("lines in another order, twice, of no recording or without sense do not disturb a resumed batch") {
  const Interrupted run(4);
  const auto events = run.events();
  run.check_resumed_from(events[3] + events[1]);
  run.check_resumed_from(events[0] + events[0] + events[2]);
  run.check_resumed_from(std::string(200, '\0') + "\n" + events[2]);
  run.check_resumed_from("\n \n{}\nfit 1 {}\n" + event("fit 99 {}") + event("fit x {}") + event("nothing 1") +
                         event("") + events[2] + events[1].substr(0, 100));
  CHECK(run.record()["before"] == 1);
  CHECK(run.record()["fitted"] == 3);
}

TEST_CASE("an altered line is done again, whatever was altered in it") {
  const Interrupted run(4);
  const auto events = run.events();
  const auto with = [&](std::size_t recording, std::string from, const std::string& to) {
    auto altered = events;
    const std::size_t place = altered[recording].find(from);
    REQUIRE(place != std::string::npos);
    altered[recording].replace(place, from.size(), to);
    return altered[0] + altered[1] + altered[2] + altered[3];
  };
  const std::string number = R"("value":1)";
  run.check_resumed_from(with(1, number, R"("value":2)"));
  CHECK(run.record()["before"] == 3);
  run.check_resumed_from(with(1, R"("id":"r1")", R"("id":"r2")"));
  CHECK(run.record()["before"] == 3);
  run.check_resumed_from(with(2, R"("id":"r2")", R"("id":"stranger")"));
  run.check_resumed_from(with(2, "{", "["));
  run.check_resumed_from(with(1, " fit 1 ", " fit 2 "));
  CHECK(run.record()["before"] == 3);
}

TEST_CASE("where results.jsonl of a finished batch was altered, it is said and done again") {
  const BatchScene scene(3);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto whole = files_in(scene.path("out"));
  std::string altered = whole.results;
  altered[altered.find(R"("value":1)") + 8] = '2';
  (void)scene.file("out/results.jsonl", altered);
  const auto run = batch(scene.manifest(), scene.path("out"), {"--resume"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Catch::Contains("results in results.jsonl were changed or damaged"));
  CHECK(files_in(scene.path("out")) == whole);
}

TEST_CASE("a batch that continues on another processor reports it, and run.json names both") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto record = [&] { return nlohmann::ordered_json::parse(content_of(scene.path("out/run.json"))); };
  const std::string here = record()["processor"];
  auto other = record();
  other["processor"] = "abacus";
  (void)scene.file("out/run.json", other.dump());
  for (int resumed = 0; resumed < 2; ++resumed) {
    const auto run = batch(scene.manifest(), scene.path("out"), {"--resume"});
    CHECK(run.exit_code == 0);
    CHECK_THAT(run.err, Catch::Contains("another processor (abacus"));
    CHECK(record()["processor"] == "abacus; " + here);
  }
}

TEST_CASE("a recording at which the process died three times has failed, and is tried again when all is done") {
  const BatchScene scene(3);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto whole = files_in(scene.path("out"));
  const auto leave = [&](const std::string& journal) {
    auto record = nlohmann::ordered_json::parse(content_of(scene.path("out/run.json")));
    record["finished"] = false;
    (void)scene.file("out/run.json", record.dump());
    (void)scene.file("out/journal", journal);
  };
  const std::string begun = event("begin 1");
  leave(begun + begun);
  CHECK(batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code == 0);
  CHECK(files_in(scene.path("out")) == whole);
  leave(begun + begun + event("begin 2") + event("end 2") + begun);
  CHECK(batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code == 1);
  CHECK(lines_of(files_in(scene.path("out")).results).size() == 2);
  CHECK_THAT(files_in(scene.path("out")).failures, Catch::Contains("\nr1,crashed,") && Catch::Contains("3 times"));
  CHECK(batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code == 0);
  CHECK(files_in(scene.path("out")) == whole);
}

TEST_CASE("a folder that is empty, or contains only the start of a batch, is used afresh") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("whole")).exit_code == 0);
  std::filesystem::create_directory(scene.path("out"));
  CHECK(batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code == 0);
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
  (void)scene.file("out/results.jsonl", "{\"schema\":\"slipf");
  CHECK(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
}

TEST_CASE("a failure is tried again when a batch is resumed") {
  const BatchScene scene(3);
  std::filesystem::rename(scene.path("r1.csv"), scene.path("away.csv"));
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 1);
  std::filesystem::rename(scene.path("away.csv"), scene.path("r1.csv"));
  CHECK(batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code == 0);
  REQUIRE(batch(scene.manifest(), scene.path("whole")).exit_code == 0);
  CHECK(files_in(scene.path("out")) == files_in(scene.path("whole")));
}

TEST_CASE("Ctrl-C and SIGTERM leave whole lines, a folder to go on with, and the exit code of the signal") {
  const BatchScene scene(5);
  const std::string manifest = long_manifest(scene);
  const auto stopped_by = [&](const std::string& signal) {
    return test::run_program(
        "timeout", {"--foreground", "--preserve-status", "--signal", signal, "0.5", SLIPFIT_EXECUTABLE, "batch",
                    manifest, "--out", scene.path("out"), "--resume", "--jobs", "2"});
  };
  const std::vector<std::pair<std::string, int>> signals{{"INT", 130}, {"TERM", 143}};
  for (const auto& [signal, exit_code] : signals) {
    const auto run = stopped_by(signal);
    CAPTURE(signal, run.err);
    CHECK(run.exit_code == exit_code);
    CHECK(test::lines_in(run.err) == 1);
    CHECK_THAT(run.err, Catch::Contains("of 5000 recordings; --resume continues"));
    const std::string journal = content_of(scene.path("out/journal"));
    REQUIRE_FALSE(journal.empty());
    CHECK(journal.back() == '\n');
    const auto record = nlohmann::json::parse(content_of(scene.path("out/run.json")));
    CHECK(record["finished"] == false);
    CHECK(record["before"].get<std::size_t>() + record["fitted"].get<std::size_t>() == fits_in(journal));
    for (const std::string name : {"results.jsonl", "summary.csv", "failures.csv"}) {
      CHECK_FALSE(std::filesystem::exists(scene.path("out/" + name)));
    }
  }
}

TEST_CASE("two batches on one folder exclude each other") {
  const BatchScene scene(5);
  const std::string both =
      "\"$0\" batch \"$1\" --out \"$2\" --quiet & first=$!; until [ -s \"$2/journal\" ]; do sleep 0.05; done; "
      "\"$0\" batch \"$1\" --out \"$2\" --resume; second=$?; kill -KILL $first; exit $second";
  const auto run = test::run_program("sh", {"-c", both, SLIPFIT_EXECUTABLE, long_manifest(scene), scene.path("out")});
  CAPTURE(run.err);
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Catch::Contains("lock: in use by process ") && Catch::Contains(" on "));
}
