#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "io/kept_recordings.hpp"
#include "temp_file.hpp"

using slipfit::reading::Container;
using slipfit::reading::KeptFile;

namespace {

template <class Number>
std::string bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

std::string text_with_length(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}

/// A TDMS file of one segment with a channel of doubles in a group.
std::string tdms(const std::string& group, const std::vector<double>& values) {
  std::string meta = bytes_of(std::uint32_t{1}) + text_with_length("/'" + group + "'/'force'") +
                     bytes_of(std::uint32_t{20}) + bytes_of(std::uint32_t{10}) + bytes_of(std::uint32_t{1}) +
                     bytes_of(std::uint64_t{values.size()}) + bytes_of(std::uint32_t{0});
  std::string raw;
  for (const double value : values) raw += bytes_of(value);
  constexpr std::uint32_t kMetaNewObjectsRaw = 14;
  return "TDSm" + bytes_of(kMetaNewObjectsRaw) + bytes_of(std::uint32_t{4713}) +
         bytes_of(std::uint64_t{meta.size() + raw.size()}) + bytes_of(std::uint64_t{meta.size()}) + meta + raw;
}

std::string text_in(const Container& container) {
  return slipfit::reading::read_all(*container.open(std::nullopt).bytes, 1000).value_or("too long");
}

}  // namespace

TEST_CASE("a kept file is read once, and anew when it has changed") {
  const std::string content = tdms("run", {1.0, 2.5});
  const io_test::TempFile file(content);
  KeptFile kept;
  const Container first = kept.open(file.path(), "file", {});
  const Container second = kept.open(file.path(), "file", {});
  CHECK(first.digester == second.digester);
  CHECK(first.tables() == std::vector<std::string>{"run"});
  CHECK(text_in(first) == "force\n1\n2.5\n");
  CHECK(text_in(second) == text_in(first));
  CHECK(second.digester->digest() == slipfit::digest_of(content));
  std::ofstream(file.path(), std::ios::binary) << tdms("other", {3.0});
  const Container third = kept.open(file.path(), "file", {});
  CHECK(text_in(third) == "force\n3\n");
  CHECK(text_in(first) == "force\n1\n2.5\n");  // its own bytes
}

TEST_CASE("a kept file that is missing has the error of any other") {
  KeptFile kept;
  CHECK_THROWS_AS(kept.open("/none/there.h5", "file", {}), slipfit::ThrownError);
}
