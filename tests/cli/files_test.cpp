// Several recordings without a manifest written by hand: fit and info of several files, batch of files and folders.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recordings.hpp"
#include "refusal.hpp"
#include "run_program.hpp"
#include "sweep_example.hpp"

using nlohmann::json;
using test::check_refused;
using test::run_slipfit;
using test::simulated_csv;

TEST_CASE("fit --joint of several files is the joint fit, with a speed each") {
  const test::SweepExample example;
  const std::string slow = example.folder.path("slow.csv");
  const std::string middle = example.folder.path("middle.csv");
  const std::string fast = example.folder.path("fast.csv");
  const json joint = example.fit({"--group", "pad"});
  const test::ProgramResult result = run_slipfit(
      {"fit", "--joint", slow, middle, fast, "--speed", "20mm/s", "--speed", "40mm/s", "--speed", "80mm/s", "--json"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  const json files = json::parse(result.out);
  CHECK(files["parameters"] == joint["parameters"]);
  CHECK(files["recordings"][1]["id"] == "middle");

  const std::string named_slow = example.folder.file("pad_20mmps.csv", test::content_of(slow));
  const std::string named_fast = example.folder.file("pad_80mmps.csv", test::content_of(fast));
  const test::ProgramResult named = run_slipfit({"fit", "--joint", named_slow, named_fast, "--json"});
  REQUIRE(named.exit_code == 0);
  CHECK(json::parse(named.out)["id"] == "pad");
  CHECK(json::parse(named.out)["recordings"][1]["recording"]["speed_m_per_s"].get<double>() == Approx(0.08));

  const std::string folder = example.folder.path("named");
  std::filesystem::create_directory(folder);
  for (const std::string& file : {named_slow, named_fast}) {
    std::filesystem::copy(file, folder + "/" + std::filesystem::path(file).filename().string());
  }
  const test::ProgramResult in_folder = run_slipfit({"fit", "--joint", folder, "--json"});
  REQUIRE(in_folder.exit_code == 0);
  CHECK(json::parse(in_folder.out)["parameters"] == json::parse(named.out)["parameters"]);
  const test::ProgramResult alone = run_slipfit({"fit", "--joint", named_slow, "--json"});
  CHECK(alone.exit_code == 0);  // one recording is no manifest
  CHECK(json::parse(alone.out)["recordings"].size() == 1);
}

TEST_CASE("a drafted manifest does not replace one of its recordings") {
  const test::TemporaryFolder folder;
  const std::string run = folder.file("a_20mmps.csv", simulated_csv("1"));
  check_refused({"manifest", folder.path(""), "--out", run}, "is the recording itself");
  CHECK(test::content_of(run) == simulated_csv("1"));
  const std::string manifest = folder.path("runs.csv");
  for (int time = 0; time < 2; ++time) {  // an earlier draft may be replaced
    CHECK(run_slipfit({"manifest", folder.path(""), "--out", manifest, "--quiet"}).exit_code == 0);
  }
}

TEST_CASE("fit, analyze and info of several files treat each on its own") {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a_20mmps.csv", simulated_csv("1"));
  const std::string b = folder.file("b.csv", simulated_csv("2"));
  const json one = json::parse(run_slipfit({"fit", b, "--speed", "20mm/s", "--json"}).out);
  const test::ProgramResult each = run_slipfit({"fit", a, b, "--speed", "20mm/s", "--json"});
  REQUIRE(each.exit_code == 0);
  CHECK_THAT(each.err, Catch::Contains("each recording was fitted separately") && Catch::Contains("--joint"));
  const json documents = json::parse(each.out);
  REQUIRE(documents.size() == 2);
  CHECK(documents[0]["schema"] == "slipfit.fit/1");
  CHECK(documents[0]["id"] == "a_20mmps");
  CHECK(documents[1]["parameters"] == one["parameters"]);
  const test::ProgramResult text = run_slipfit({"analyze", a, b, "--speed", "20mm/s", "--quiet"});
  CHECK(text.exit_code == 0);
  CHECK(text.err.empty());
  CHECK_THAT(text.out, Catch::Contains("a_20mmps.csv: stick-slip") && Catch::Contains("b.csv: stick-slip"));
  const test::ProgramResult info = run_slipfit({"info", a, b});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.out, Catch::Contains(a) && Catch::Contains(b));
  CHECK(json::parse(run_slipfit({"info", a, b, "--json"}).out).size() == 2);
  CHECK(json::parse(run_slipfit({"info", a, "--json"}).out)["schema"] == "slipfit.info/1");
}

TEST_CASE("of several files those that cannot be read are named, and the others are fitted") {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a.csv", simulated_csv("1"));
  const std::string b = folder.file("b.csv", simulated_csv("2"));
  const test::ProgramResult some = run_slipfit({"fit", a, folder.path("none.csv"), b, "--speed", "20mm/s", "--json"});
  CHECK(some.exit_code == 1);
  CHECK_THAT(some.err, Catch::Contains("none.csv") && Catch::Contains("1 of 3 recordings failed"));
  CHECK(json::parse(some.out).size() == 2);
  const test::ProgramResult none = run_slipfit({"info", folder.path("x.csv"), folder.path("y.csv")});
  CHECK(none.exit_code == 3);
  check_refused({"fit", a, b, "--speed", "20mm/s", "--report", folder.path("r.html")}, "--report applies to one");
  check_refused({"fit", a, b, "--speed", "20mm/s", "--cycles", folder.path("c.csv")}, "--cycles applies to one");
}

TEST_CASE("a stated speed takes precedence over that of a name, with a message") {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a_20mmps.csv", simulated_csv("1"));
  const std::string b = folder.file("b_20mmps.csv", simulated_csv("2"));
  const test::ProgramResult fit = run_slipfit({"fit", a, b, "--speed", "10mm/s", "--json"});
  REQUIRE(fit.exit_code == 0);
  CHECK_THAT(fit.err, Catch::Contains("states 0.02 m/s, but --speed states 0.01 m/s, which is used"));
  CHECK(json::parse(fit.out)[0]["recording"]["speed_m_per_s"] == 0.01);
  const std::string out = folder.path("out");
  const test::ProgramResult batch = run_slipfit({"batch", a, b, "--out", out, "--speed", "10mm/s"});
  REQUIRE(batch.exit_code == 0);
  CHECK_THAT(batch.err, Catch::Contains("but --speed states 0.01 m/s, which is used"));
  CHECK_THAT(test::content_of(out + "/manifest.csv"), Catch::Contains("a_20mmps,../a_20mmps.csv,0.01,"));
  CHECK(test::lines_in(test::content_of(out + "/results.jsonl")) == 2);
}

TEST_CASE("batch takes one recording, several and folders, and a manifest alone") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("runs"));
  static_cast<void>(folder.file("runs/c.csv", simulated_csv("3")));
  const std::string a = folder.file("a.csv", simulated_csv("1"));
  const std::string one = folder.path("one");
  REQUIRE(run_slipfit({"batch", a, "--out", one, "--speed", "20mm/s", "--quiet"}).exit_code == 0);
  CHECK(test::lines_in(test::content_of(one + "/results.jsonl")) == 1);
  const std::string two = folder.path("two");
  REQUIRE(run_slipfit({"batch", a, folder.path("runs"), "--out", two, "--speed", "20mm/s", "--quiet"}).exit_code == 0);
  CHECK(test::lines_in(test::content_of(two + "/results.jsonl")) == 2);
  check_refused({"batch", a, one + "/manifest.csv", "--out", folder.path("o"), "--speed", "1"}, "is a manifest");
  const std::string broken = folder.file("broken.csv", "id,fil,speed_m_per_s\na,a.csv,0.02\n");
  check_refused({"batch", broken, "--out", folder.path("o")}, "there is no column 'file'");
}

TEST_CASE("fit --joint of several files refuses in one line what it cannot do, with a remedy that works") {
  const test::SweepExample example;
  const std::string slow = example.folder.path("slow.csv");
  const std::string fast = example.folder.path("fast.csv");
  check_refused({"fit", "--joint", slow, fast}, "slipfit manifest " + slow + " --out runs.csv");
  check_refused({"fit", "--joint", slow, fast, slow, "--speed", "1", "--speed", "2"}, "--speed is given 2 times");
  check_refused({"fit", "--joint", slow, fast, "--speed", "1", "--cycles", example.folder.path("c.csv")}, "--cycles");
  check_refused({"fit", "--joint", slow, fast, "--speed", "1", "--group", "pad"}, "of a manifest");
  check_refused({"fit", "--joint", slow, fast, "--speed", "1", "--only", "slow"}, "of a manifest");
  check_refused({"fit", "--joint", slow, fast, "--speed", "1", "--tier", "sawtooth"}, "no tier of a joint fit");
  const std::string drafted = example.folder.path("runs.csv");
  CHECK(run_slipfit({"manifest", slow, fast, "--out", drafted, "--quiet"}).exit_code == 0);
  const test::ProgramResult missing =
      run_slipfit({"fit", "--joint", slow, example.folder.path("none.csv"), "--speed", "1"});
  CHECK(missing.exit_code == 3);
  CHECK_THAT(missing.err, Catch::Contains("none.csv"));
  const std::string two = example.folder.file("two.csv", "time,left force,right force\n0,1,2\n1,2,1\n2,1,2\n3,2,1\n");
  const test::ProgramResult ambiguous = run_slipfit({"fit", "--joint", slow, two, "--speed", "1"});
  CHECK(ambiguous.exit_code == 3);
  CHECK_THAT(ambiguous.err, Catch::Contains("--force-column") && !Catch::Contains("manifest"));
}

TEST_CASE("batch takes a folder: its manifest is drafted, and options state what the names do not") {
  const test::TemporaryFolder folder;
  const std::string runs = folder.path("runs");
  std::filesystem::create_directory(runs);
  static_cast<void>(folder.file("runs/a_20mmps.csv", simulated_csv("1")));
  static_cast<void>(folder.file("runs/b.csv", simulated_csv("2")));
  const std::string out = folder.path("runs/out");
  const std::vector<std::string> command{"batch",  runs,     "--out", out,      "--speed",
                                         "10mm/s", "--zero", "0.5 N", "--quiet"};
  REQUIRE(run_slipfit(command).exit_code == 0);
  const std::string manifest = test::content_of(out + "/manifest.csv");
  CHECK_THAT(manifest, Catch::Contains("zero_force") && Catch::Contains("a_20mmps,../a_20mmps.csv,0.01,") &&
                           Catch::Contains("b,../b.csv,0.01,"));
  const std::string results = test::content_of(out + "/results.jsonl");
  CHECK(test::lines_in(results) == 2);
  CHECK_THAT(results, Catch::Contains("\"zero_force_N\":0.5"));

  std::vector<std::string> again = command;
  check_refused(again, "--resume");
  again.push_back("--resume");
  CHECK(run_slipfit(again).exit_code == 0);
  again[5] = "30mm/s";
  check_refused(again, "differs from the manifest of these files");
  check_refused({"batch", runs, "--out", out, "--shard", "1/2"}, "slipfit manifest");
  check_refused({"batch", runs, "--out", out, "--step", "1"}, "--step");
  check_refused({"batch", out + "/manifest.csv", "--out", folder.path("o"), "--speed", "1"},
                "--speed cannot be combined with");
  CHECK(test::content_of(out + "/results.jsonl") == results);
}

TEST_CASE("sample, material and operator of a manifest reach results and pages, whose heading is the file's name") {
  const test::TemporaryFolder folder;
  static_cast<void>(folder.file("run.csv", simulated_csv("1")));
  const std::string manifest = folder.file(
      "runs.csv", "id,file,speed_m_per_s,group,sample,material,operator\nr,run.csv,0.02,dry,S7,<EPDM>,K\u00F6nig\n");
  const std::string out = folder.path("out");
  REQUIRE(run_slipfit({"batch", manifest, "--out", out, "--quiet", "--report", out + "/index.html"}).exit_code == 0);
  const json recording = json::parse(test::content_of(out + "/results.jsonl"))["recording"];
  CHECK(recording["sample"] == "S7");
  CHECK(recording["material"] == "<EPDM>");
  CHECK(recording["operator"] == "K\u00F6nig");
  CHECK(recording["group"] == "dry");
  const std::string page = test::content_of(out + "/recordings/00001-r.html");
  CHECK_THAT(page, Catch::Contains("<h1>run.csv</h1>") &&
                       Catch::Contains("<p class=\"file\">" + folder.path("run.csv")) &&
                       Catch::Contains("sample: S7") && Catch::Contains("material: &lt;EPDM&gt;") &&
                       Catch::Contains("operator: K\u00F6nig"));
}

TEST_CASE("drafts: names with line ends are left out, and no name runs as a formula in a spreadsheet") {
  const test::TemporaryFolder folder;
  (void)folder.file("=1+1 v10mmps.csv", test::simulated_csv("7"));
  (void)folder.file("@sum v10mmps.csv", test::simulated_csv("8"));
  (void)folder.file("a\nb,=2,0.01 v10mmps.csv", test::simulated_csv("9"));
  const auto draft = run_slipfit({"manifest", folder.path("")});
  CHECK_THAT(draft.err, Catch::Contains("the name contains a line end"));
  CHECK(test::lines_in(draft.out) == 3);
  const std::string out = folder.path("out");
  const auto run = run_slipfit({"batch", folder.path(""), "--out", out});
  CAPTURE(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Catch::Contains("left out: ") &&
                          Catch::Contains("a\\nb,=2,0.01 v10mmps.csv: the name contains a line end"));
  for (const char* const name : {"manifest.csv", "summary.csv"}) {
    const std::string table = test::content_of(out + "/" + name);
    CAPTURE(table);
    CHECK(test::lines_in(table) == 3);
    for (const char* const start : {"\n=", ",=", "\n@", ",@", "\"=", "\"@"}) CHECK_THAT(table, !Catch::Contains(start));
    CHECK_THAT(table, Catch::Contains("'=1+1") && Catch::Contains("'@sum"));
  }
}

TEST_CASE("a result that replaces a file keeps its mode, and a new one has that of the umask") {
  namespace fs = std::filesystem;
  const test::TemporaryFolder folder;
  const std::string recording = folder.file("run.csv", simulated_csv("1"));
  const std::string out = folder.path("result.json");
  const std::vector<std::string> fit{"fit", recording, "--speed", "0.02", "--quiet", "--json", "--out", out};
  const auto mode = [&] { return fs::status(out).permissions(); };
  REQUIRE(run_slipfit(fit).exit_code == 0);
  CHECK((mode() & fs::perms::owner_exec) == fs::perms::none);
  for (const auto own : {fs::perms::owner_read | fs::perms::owner_write, fs::perms::all}) {
    fs::permissions(out, own);
    REQUIRE(run_slipfit(fit).exit_code == 0);
    CHECK(mode() == own);
  }
}
