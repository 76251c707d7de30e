#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "manifests.hpp"

using Catch::Contains;
using test::batch;
using test::BatchScene;
using test::files_in;

namespace fs = std::filesystem;

namespace {

/// Every page of a report, by its place.
std::map<std::string, std::string> pages_in(const fs::path& folder) {
  std::map<std::string, std::string> pages;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      pages[fs::relative(entry.path(), folder).string()] = test::content_of(entry.path().string());
  }
  return pages;
}

std::vector<std::string> names_of(const std::map<std::string, std::string>& pages) {
  std::vector<std::string> names;
  for (const auto& [name, content] : pages) names.push_back(name);
  return names;
}

std::vector<std::string> reported(const BatchScene& scene, const std::string& folder, std::vector<std::string> more) {
  more.insert(more.end(), {"--report", scene.path(folder + "/index.html")});
  return more;
}

}  // namespace

TEST_CASE("a batch's report is an index and a page a recording and group, the same for any number of jobs") {
  const BatchScene scene(5);
  const auto run = batch(scene.manifest(), scene.path("a"), reported(scene, "one", {"--joint-groups", "--jobs", "1"}));
  CAPTURE(run.err);
  (void)batch(scene.manifest(), scene.path("b"), reported(scene, "eight", {"--joint-groups", "--jobs", "8"}));
  const auto pages = pages_in(scene.path("one"));
  CHECK(pages == pages_in(scene.path("eight")));
  CHECK(names_of(pages) ==
        std::vector<std::string>{"index.html", "recordings/00001-r0.html", "recordings/00002-r1.html",
                                 "recordings/00003-r2.html", "recordings/00004-r3.html", "recordings/00005-r4.html",
                                 "recordings/00006-group_g0.html", "recordings/00007-group_g1.html"});
  const std::string& index = pages.at("index.html");
  CHECK(index.find("00001-r0.html\">r0</a>") < index.find("00005-r4.html\">r4</a>"));
  CHECK_THAT(index, Contains("00006-group_g0.html\">group:g0</a>") && Contains("class=\"spark\""));
  CHECK_THAT(pages.at("recordings/00002-r1.html"),
             Contains("r1.csv</p>") && Contains("runs.csv --joint-groups  # row 2: r1</code>"));
  (void)batch(scene.manifest(), scene.path("plain"), {"--joint-groups"});
  CHECK(files_in(scene.path("a")) == files_in(scene.path("plain")));
}

TEST_CASE("a report of a finished batch can be asked for later, and makes only the pages that are missing") {
  const BatchScene scene(3);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  const auto results = files_in(scene.path("out"));
  REQUIRE(batch(scene.manifest(), scene.path("out"), reported(scene, "page", {"--resume"})).exit_code == 0);
  const auto pages = pages_in(scene.path("page"));
  CHECK(pages.size() == 4);
  CHECK(files_in(scene.path("out")) == results);

  const fs::path kept = scene.path("page/recordings/00001-r0.html");
  const auto long_ago = fs::last_write_time(kept) - std::chrono::hours(1);
  fs::last_write_time(kept, long_ago);
  fs::remove(scene.path("page/recordings/00002-r1.html"));
  std::ofstream(scene.path("page/recordings/00003-r2.html")) << "<!DOCTYPE html> a part of a page, or another batch's";
  REQUIRE(batch(scene.manifest(), scene.path("out"), reported(scene, "page", {"--resume"})).exit_code == 0);
  CHECK(pages_in(scene.path("page")) == pages);
  CHECK(fs::last_write_time(kept) == long_ago);
}

TEST_CASE("shards may share a report's folder, and after the merge the index is made of the pages at hand") {
  const BatchScene scene(4);
  (void)batch(scene.manifest(), scene.path("single"), reported(scene, "whole", {}));
  for (const std::string shard : {"1/2", "2/2"}) {
    const std::string out = scene.path("shard" + shard.substr(0, 1));
    REQUIRE(batch(scene.manifest(), out, reported(scene, "pages", {"--shard", shard})).exit_code == 0);
  }
  CHECK_FALSE(fs::exists(scene.path("pages/index.html")));
  const fs::path first = scene.path("pages/recordings/00001-r0.html");
  const auto written = fs::last_write_time(first);
  REQUIRE(test::run_slipfit({"merge", scene.path("shard1"), scene.path("shard2"), "--out", scene.path("merged")})
              .exit_code == 0);
  REQUIRE(batch(scene.manifest(), scene.path("merged"), reported(scene, "pages", {"--resume"})).exit_code == 0);
  CHECK(pages_in(scene.path("pages")) == pages_in(scene.path("whole")));
  CHECK(fs::last_write_time(first) == written);
}

TEST_CASE("page and row of a recording that changed since are of the same bytes") {
  const BatchScene scene(2);
  REQUIRE(batch(scene.manifest(), scene.path("out")).exit_code == 0);
  fs::copy_file(scene.path("r1.csv"), scene.path("r0.csv"), fs::copy_options::overwrite_existing);
  REQUIRE(batch(scene.manifest(), scene.path("out"), reported(scene, "page", {"--resume"})).exit_code == 0);
  const std::string index = test::content_of(scene.path("page/index.html"));
  CHECK_THAT(index, Contains("00001-r0.html\">r0</a>") && Contains("00002-r1.html\">r1</a>"));
  const auto line = nlohmann::json::parse(test::lines_of(files_in(scene.path("out")).results).at(0));
  CHECK_THAT(test::content_of(scene.path("page/recordings/00001-r0.html")),
             Contains(line["recording"]["input_digest"].get<std::string>()));
}

TEST_CASE("names and messages from outside stay text, and failures are on the page") {
  const BatchScene scene(1);
  const std::string manifest = scene.file(
      "<b>runs&.csv", "id,file,speed_m_per_s\n<script>alert(1),r0.csv,0.02\nbad<img>,<img src=x>.csv,0.02\n");
  CHECK(batch(manifest, scene.path("out"), reported(scene, "page", {})).exit_code == 1);
  const auto pages = pages_in(scene.path("page"));
  CHECK(names_of(pages) == std::vector<std::string>{"index.html", "recordings/00001-_script_alert_1_.html"});
  const std::string& index = pages.at("index.html");
  CHECK_THAT(index, !Contains("<script>alert") && !Contains("<img") && !Contains("<b>runs"));
  CHECK_THAT(index, Contains("1 recording: 1 stick-slip; 1 failed.") && Contains("file_not_found") &&
                        Contains("bad&lt;img&gt;"));
}

TEST_CASE("a report replaces only pages, and its name must be that of a page") {
  const BatchScene scene(1);
  const std::string before = test::content_of(scene.path("r0.csv"));
  const std::string manifest = scene.file("input.html", "id,file,speed_m_per_s\nr0,r0.csv,0.02\n");
  const auto input = batch(manifest, scene.path("out"), {"--report", manifest});
  CHECK(input.exit_code == 2);
  CHECK_THAT(input.err, Contains("input.html: is not a page") && Contains("--report"));
  CHECK(batch(scene.manifest(), scene.path("out"), {"--report", scene.path("r0.csv")}).exit_code == 2);
  CHECK(batch(scene.manifest(), scene.path("out"), {"--report", scene.path("none/none/index.html")}).exit_code == 2);
  CHECK(test::content_of(scene.path("r0.csv")) == before);
  CHECK_FALSE(fs::exists(scene.path("out/results.jsonl")));

  fs::create_directories(scene.path("page/recordings"));
  std::ofstream(scene.path("page/recordings/00001-r0.html")) << "time,force\n";
  CHECK(batch(scene.manifest(), scene.path("out"), reported(scene, "page", {})).exit_code == 2);
  CHECK(test::content_of(scene.path("page/recordings/00001-r0.html")) == "time,force\n");
}
