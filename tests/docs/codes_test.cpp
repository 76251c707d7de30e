#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

fs::path project_folder() {
  return fs::path(SLIPFIT_TESTDATA_DIR).parent_path();
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  REQUIRE(stream);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// All of src and apps, file after file.
std::string sources() {
  std::vector<fs::path> files;
  for (const char* folder : {"src", "apps"}) {
    for (const auto& entry : fs::recursive_directory_iterator(project_folder() / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() == ".cpp" || file.extension() == ".hpp") files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  std::string text;
  for (const fs::path& file : files) text += content_of(file);
  return text;
}

/// What stands in the first group of each match.
std::set<std::string> matches_of(const std::string& text, const std::string& expression) {
  const std::regex pattern(expression);
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

/// A way in which the sources make an error or a warning, with a code that it must find, lest the pattern fall silent.
struct Form {
  const char* expression;
  const char* example;
  const char* section;  ///< of docs/formats.md, where the code must stand
};
const std::vector<Form> kForms{
    {R"form(Error(?: \w+)?\(?\s*\{\s*"(\w+)")form", "unknown_column", "## Errors"},
    // Short tests and what they are called are made so too.
    {R"form(return (?:\{\s*)+"([a-z0-9]+_[a-z0-9_]+)",)form", "parameter_out_of_range", "# Formats"},
    {R"form(refusal\(\s*"(\w+)")form", "bad_rows", "## Errors"},
    {R"form(Warning\{\s*"(\w+)")form", "samples_averaged", "## Warnings"},
    {R"form(warnings\.push_back\(\s*\{\s*"(\w+)")form", "hum_fitted", "## Warnings"},
    {R"form(\{"(\w+)", RuleKind::)form", "uneven_clock", "## Warnings"},
};

/// Under a heading, up to the next one of its rank.
std::string part_of(const std::string& text, const std::string& heading) {
  const std::size_t begin = text.find(heading + "\n");
  REQUIRE(begin != std::string::npos);
  return text.substr(begin, text.find("\n" + heading.substr(0, heading.find(' ') + 1), begin) - begin);
}

}  // namespace

TEST_CASE("docs/formats.md names every code of an error or a warning in src and apps") {
  const std::string formats = content_of(project_folder() / "docs/formats.md");
  const std::string text = sources();
  for (const Form& form : kForms) {
    const std::set<std::string> codes = matches_of(text, form.expression);
    const std::string section = part_of(formats, form.section);
    INFO(form.section << ", pattern " << form.expression);
    CHECK(codes.count(form.example) == 1);
    for (const std::string& code : codes) CHECK_THAT(section, Catch::Contains("`" + code + "`"));
  }
}

TEST_CASE("every code in the tables of errors and warnings of docs/formats.md is one of the sources") {
  const std::string formats = content_of(project_folder() / "docs/formats.md");
  const std::string text = sources();
  for (const char* heading : {"## Errors", "## Warnings"}) {
    std::string cells;
    for (const std::string& cell : matches_of(part_of(formats, heading), R"(\n\|([^|]*)\|)")) cells += cell;
    const std::set<std::string> codes = matches_of(cells, "`([a-z0-9_]+)`");
    CHECK(codes.size() > 20);
    for (const std::string& code : codes) CHECK_THAT(text, Catch::Contains("\"" + code + "\""));
  }
}

TEST_CASE("every warning that the sources make has a rule, and every rule without a condition is made somewhere") {
  const std::string text = sources();
  const std::set<std::string> rules = matches_of(text, R"form(\{"(\w+)", RuleKind::)form");
  for (const char* form : {R"form(Warning\{\s*"(\w+)")form", R"form(warnings\.push_back\(\s*\{\s*"(\w+)")form"}) {
    for (const std::string& code : matches_of(text, form)) CHECK(rules.count(code) == 1);
  }
  for (const std::string& code : matches_of(text, R"form(\{"(\w+)", RuleKind::\w+(?:, nullptr[^}]*)?\})form")) {
    CAPTURE(code);
    const std::string quoted = "\"" + code + "\"";
    CHECK(text.find(quoted, text.find(quoted) + 1) != std::string::npos);
  }
}
