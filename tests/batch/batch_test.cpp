#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "manifests.hpp"

using test::batch;
using test::BatchScene;
using test::files_in;
using test::lines_of;

namespace {

/// The results, but for the groups that the manifest gives.
std::string without_groups(const std::string& results) {
  std::string text;
  for (const std::string& line : lines_of(results)) {
    auto document = nlohmann::ordered_json::parse(line);
    document["recording"].erase("group");
    text += document.dump() + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("a batch writes one document and one summary row a recording, in the manifest's order, and nothing else") {
  const BatchScene scene(7);
  const auto run = batch(scene.manifest(), scene.path("out"));
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK(run.out.empty());
  CHECK(test::lines_in(run.err) == 1);
  const auto files = files_in(scene.path("out"));
  const auto documents = lines_of(files.results);
  const auto summary = lines_of(files.summary);
  REQUIRE(documents.size() == 7);
  REQUIRE(summary.size() == 8);
  for (std::size_t i = 0; i < 7; ++i) {
    CHECK(nlohmann::json::parse(documents[i])["id"] == "r" + std::to_string(i));
    CHECK_THAT(summary[i + 1], Catch::StartsWith(std::to_string(i + 1) + ",r" + std::to_string(i) + ","));
  }
  CHECK(files.failures == "id,code,message\n");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scene.path("out"))) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"failures.csv", "results.jsonl", "run.json", "summary.csv"});
}

TEST_CASE("a line of results.jsonl is the document of slipfit fit, on one line") {
  const BatchScene scene(1);
  REQUIRE(batch(scene.manifest(), scene.path("out"), {"--tier", "undamped"}).exit_code == 0);
  const auto fit = test::run_slipfit({"fit", scene.path("r0.csv"), "--speed", "0.02", "--tier", "undamped", "--json"});
  const auto expected = nlohmann::ordered_json::parse(fit.out);
  CHECK(without_groups(files_in(scene.path("out")).results) == expected.dump() + "\n");
}

TEST_CASE("the files of a batch do not depend on the number of jobs") {
  const BatchScene scene(12);
  REQUIRE(batch(scene.manifest(), scene.path("one"), {"--jobs", "1"}).exit_code == 0);
  REQUIRE(batch(scene.manifest(), scene.path("eight"), {"--jobs", "8"}).exit_code == 0);
  CHECK(files_in(scene.path("one")) == files_in(scene.path("eight")));
}

TEST_CASE("the columns of the manifest reach the fit: units, window, normal force, measured spacing") {
  const BatchScene scene(5);
  const std::string manifest = scene.file(
      "other.csv",
      "id,file,speed [mm/s],normal_force_N,window_s,measured_spacing_m,force_view\nx,r4.csv,20,7,0:2.5,0.004,\n");
  REQUIRE(batch(manifest, scene.path("out")).exit_code == 0);
  const auto document = nlohmann::json::parse(files_in(scene.path("out")).results);
  CHECK(document["recording"]["speed_m_per_s"] == 0.02);
  CHECK(document["recording"]["normal_force_N"] == 7.0);
  CHECK(document["recording"]["duration_s"].get<double>() == Approx(2.5).margin(0.002));
  CHECK(document["derived"]["measured_spacing_En"]["value"].is_number());
}

TEST_CASE("one recording's failure is a row of failures.csv with its code, and touches no other") {
  const BatchScene scene(3);
  (void)scene.file("text.csv", "no numbers here\n");
  (void)scene.file("a,b \"c\".csv", "x\n");
  std::filesystem::create_directory(scene.path("folder"));
  const std::string manifest = scene.file("mixed.csv",
                                          "id,file,speed_m_per_s\nr0,r0.csv,0.02\nnone,none.csv,0.02\n"
                                          "dir,folder,0.02\nr1,r1.csv,0.02\ntext,text.csv,0.02\n"
                                          "\"odd, name\",\"a,b \"\"c\"\".csv\",0.02\nr2,r2.csv,0.02\n");
  const auto run = batch(manifest, scene.path("out"));
  CAPTURE(run.err);
  CHECK(run.exit_code == 1);
  CHECK(test::lines_in(run.err) == 1);
  CHECK_THAT(run.err, Catch::Contains("4 of 7 recordings failed") && Catch::Contains("failures.csv"));
  const auto files = files_in(scene.path("out"));
  const auto failures = lines_of(files.failures);
  REQUIRE(failures.size() == 5);
  CHECK_THAT(failures[1], Catch::StartsWith("none,file_not_found,") && Catch::Contains("none.csv"));
  CHECK_THAT(failures[2], Catch::StartsWith("dir,is_directory,"));
  CHECK_THAT(failures[3], Catch::StartsWith("text,no_numeric_column,"));
  CHECK_THAT(failures[4], Catch::StartsWith("\"odd, name\",no_numeric_column,"));
  const auto summary = lines_of(files.summary);
  REQUIRE(summary.size() == 8);
  CHECK_THAT(summary[2],
             Catch::StartsWith("2,none,") && Catch::Contains(",failed,") && Catch::EndsWith(",file_not_found"));
  CHECK(std::count(summary[2].begin(), summary[2].end(), ',') == std::count(summary[0].begin(), summary[0].end(), ','));
  REQUIRE(batch(scene.manifest(), scene.path("alone")).exit_code == 0);
  CHECK(files.results == without_groups(files_in(scene.path("alone")).results));
}

TEST_CASE("what the manifest calls its recordings never runs as a formula in a spreadsheet") {
  const BatchScene scene(1);
  const std::string manifest = scene.file("formulas.csv",
                                          "id,file,speed_m_per_s,group\n=1+1,r0.csv,0.02,@g\n+a,none.csv,0.02,-g\n"
                                          "\"=HYPERLINK(\"\"x\"\")\",none.csv,0.02,\nplain-1,none.csv,0.02,\n");
  CHECK(batch(manifest, scene.path("out")).exit_code == 1);
  const auto files = files_in(scene.path("out"));
  const auto summary = lines_of(files.summary);
  REQUIRE(summary.size() == 5);
  CHECK_THAT(summary[1], Catch::StartsWith("1,'=1+1,'@g,"));
  CHECK_THAT(summary[2], Catch::StartsWith("2,'+a,'-g,"));
  CHECK_THAT(summary[3], Catch::StartsWith("3,\"'=HYPERLINK(\"\"x\"\")\",,"));
  CHECK_THAT(summary[4], Catch::StartsWith("4,plain-1,,"));
  const auto failures = lines_of(files.failures);
  REQUIRE(failures.size() == 4);
  CHECK_THAT(failures[1], Catch::StartsWith("'+a,file_not_found,"));
  CHECK(nlohmann::json::parse(files.results)["id"] == "=1+1");
}

TEST_CASE("a remedy names the column of the manifest, not the option of slipfit fit") {
  const BatchScene scene(1);
  (void)scene.file("two.csv", "time_s,force_a_N,force_b_N\n0,1,2\n1,2,3\n2,3,4\n3,1,2\n");
  const std::string manifest = scene.file("two_forces.csv", "id,file,speed_m_per_s\na,two.csv,0.02\n");
  CHECK(batch(manifest, scene.path("out")).exit_code == 1);
  const auto failures = lines_of(files_in(scene.path("out")).failures);
  CAPTURE(failures);
  CHECK_THAT(failures.at(1), Catch::Contains("the manifest's force_column") && !Catch::Contains("--force-column"));
}

TEST_CASE("run.json records what was run and how it ended") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out"), {"--jobs", "2", "--fix", "damping_ratio=0.05"}).exit_code == 0);
  const auto run = nlohmann::json::parse(test::content_of(scene.path("out/run.json")));
  CHECK(run["schema"] == "slipfit.run/1");
  CHECK_THAT(run["build"].get<std::string>(), Catch::Contains(", sources "));
  CHECK_FALSE(run["processor"].get<std::string>().empty());
  CHECK(run["manifest"] == scene.manifest());
  CHECK(run["options"]["fix"]["damping_ratio"] == 0.05);
  CHECK(run["jobs"] == 2);
  CHECK(run["rows"] == 2);
  CHECK(run["fitted"] == 2);
  CHECK(run["failed"] == 0);
  CHECK(run["finished"] == true);
  CHECK(run["seconds"].get<double>() > 0.0);
}

TEST_CASE("files of a batch have the mode that the umask leaves, and keep one that the user gave them") {
  namespace fs = std::filesystem;
  const BatchScene scene(2);
  fs::remove(scene.path("r1.csv"));
  const auto run = test::run_program("sh", {"-c", "umask 027; exec \"$0\" batch \"$1\" --out \"$2\"",
                                            SLIPFIT_EXECUTABLE, scene.manifest(), scene.path("out")});
  REQUIRE(run.exit_code == 1);
  const auto mode = [&](const std::string& name) { return fs::status(scene.path("out/" + name)).permissions(); };
  const fs::perms own = fs::perms::owner_read | fs::perms::owner_write;
  for (const std::string name : {"results.jsonl", "summary.csv", "run.json"})
    CHECK(mode(name) == (own | fs::perms::group_read));
  fs::permissions(scene.path("out/results.jsonl"), own);
  REQUIRE(test::run_program("mkfifo", {scene.path("r1.csv")}).exit_code == 0);  // it blocks: the batch stays unfinished
  (void)test::run_program("timeout", {"--signal", "KILL", "1", SLIPFIT_EXECUTABLE, "batch", scene.manifest(), "--out",
                                      scene.path("out"), "--resume"});
  CHECK(mode("journal") == own);
  fs::remove(scene.path("r1.csv"));
  // The child of the batch that was killed may hold the folder for a moment (exit code 2).
  int exit_code = 2;
  for (int i = 0; i < 50 && exit_code == 2; ++i) {
    exit_code = batch(scene.manifest(), scene.path("out"), {"--resume"}).exit_code;
    if (exit_code == 2) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  REQUIRE(exit_code == 1);
  CHECK(mode("results.jsonl") == own);
}
