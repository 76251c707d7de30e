#include "io/container/kept_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

/// A file for one test, gone behind it.
struct OneFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "slipfit-kept-file.txt";

  OneFile() = default;
  OneFile(const OneFile&) = delete;
  OneFile& operator=(const OneFile&) = delete;
  OneFile(OneFile&&) = delete;
  OneFile& operator=(OneFile&&) = delete;
  ~OneFile() { std::filesystem::remove(path); }
  void write(const std::string& text) const { std::ofstream(path) << text; }
};

}  // namespace

TEST_CASE("a kept file is read once, and anew when it has changed") {
  const OneFile file;
  const std::string text(100000, 'a');
  file.write(text);
  slipfit::reading::KeptFile kept;
  const auto first = kept.open(file.path);
  const auto second = kept.open(file.path);
  CHECK(first.memory == second.memory);
  CHECK(slipfit::reading::read_all(*first.bytes, text.size()) == text);
  CHECK(slipfit::reading::read_all(*second.bytes, text.size()) == text);
  CHECK(second.start == text.substr(0, second.start.size()));
  CHECK(second.digester->digest() == slipfit::digest_of(text));
  file.write("other");
  const auto third = kept.open(file.path);
  CHECK(slipfit::reading::read_all(*third.bytes, text.size()) == "other");
  CHECK(slipfit::reading::read_all(*first.bytes, text.size()) == "");  // its own place, its own bytes
  CHECK(third.digester->digest() == slipfit::digest_of("other"));
}

TEST_CASE("a kept file that is missing has the error of any other") {
  slipfit::reading::KeptFile kept;
  CHECK_THROWS_AS(kept.open("/none/there.h5"), slipfit::ThrownError);
}
