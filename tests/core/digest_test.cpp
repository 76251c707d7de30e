#include "slipfit/core/digest.hpp"

#include <catch2/catch.hpp>
#include <string>

using slipfit::digest_of;

TEST_CASE("the digest is that of xxh128sum") {
  // printf '' | xxh128sum; printf abc | xxh128sum
  CHECK(digest_of("").text() == "xxh128:99aa06d3014798d86001c324468d497f");
  CHECK(digest_of("abc").text() == "xxh128:06b05ab6733a618578af5f94892f3950");
}

TEST_CASE("the digest does not depend on the pieces in which the bytes come") {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * i % 251);
  for (const std::size_t piece : {1U, 7U, 64U, 240U, 4096U}) {
    slipfit::Digester digester;
    for (std::size_t i = 0; i < bytes.size(); i += piece) digester.add(std::string_view(bytes).substr(i, piece));
    CHECK(digester.digest() == digest_of(bytes));
    CHECK(digester.bytes() == bytes.size());
  }
}

TEST_CASE("a file that is not regular has no digest") {
  CHECK_FALSE(slipfit::digest_of_file("/no/such/file"));
  CHECK_FALSE(slipfit::digest_of_file("/tmp"));
  CHECK_FALSE(slipfit::digest_of_file("/dev/null"));
}
