// batch_page OUT.html FIT.json...: the page of a batch from fit documents, for scripts/test-report.sh. A recording's
// own page is FIT.html beside its document.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "slipfit/io/recording_reader.hpp"
#include "slipfit/report/batch_html.hpp"

namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

slipfit::BatchPageRow row_of(const fs::path& file) {
  const std::string document = content_of(file);
  const nlohmann::json json = nlohmann::json::parse(document);
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = json["recording"]["speed_m_per_s"];
  const auto recording = slipfit::read_recording(json["recording"]["file"], conditions, {});
  return {document, file.filename().replace_extension(".html").string(),
          recording ? sparkline_of(recording.value()) : std::vector<double>{}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  slipfit::BatchPage batch{
      "Batch of the browser test", {}, {{"</script><script>alert(1)</script>", "empty", "no data"}}};
  for (int i = 2; i < argc; ++i) batch.rows.push_back(row_of(argv[i]));
  const auto page = to_html(batch);
  if (!page) {
    std::fprintf(stderr, "batch_page: %s\n", page.error().message.c_str());
    return 1;
  }
  std::ofstream(argv[1], std::ios::binary) << page.value();
  return 0;
}
