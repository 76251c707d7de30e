#include "io/container/kept_file.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "temp_file.hpp"

TEST_CASE("a kept file is read once, and anew when it has changed") {
  const std::string text(100000, 'a');
  const io_test::TempFile file(text);
  slipfit::reading::KeptFile kept;
  const auto first = kept.open(file.path());
  const auto second = kept.open(file.path());
  CHECK(first.memory == second.memory);
  CHECK(slipfit::reading::read_all(*first.bytes, text.size()) == text);
  CHECK(slipfit::reading::read_all(*second.bytes, text.size()) == text);
  CHECK(second.start == text.substr(0, second.start.size()));
  CHECK(second.digester->digest() == slipfit::digest_of(text));
  std::ofstream(file.path()) << "other";
  const auto third = kept.open(file.path());
  CHECK(slipfit::reading::read_all(*third.bytes, text.size()) == "other");
  CHECK(slipfit::reading::read_all(*first.bytes, text.size()) == "");  // its own place, its own bytes
  CHECK(third.digester->digest() == slipfit::digest_of("other"));
}

TEST_CASE("a kept file that is missing has the error of any other") {
  slipfit::reading::KeptFile kept;
  CHECK_THROWS_AS(kept.open("/none/there.h5"), slipfit::ThrownError);
}
