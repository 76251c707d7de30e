#include "slipfit/io/file_hash.hpp"

#include <catch2/catch.hpp>

#include "temp_file.hpp"

TEST_CASE("the SHA-256 of a file is that of FIPS 180-4's example") {
  const io_test::TempFile file("abc");
  CHECK(slipfit::sha256_of_file(file.path()) == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("what cannot be read has no hash") {
  CHECK_FALSE(slipfit::sha256_of_file("/no/such/file"));
  CHECK_FALSE(slipfit::sha256_of_file("/tmp"));
  CHECK_FALSE(slipfit::sha256_of_file("/dev/null"));
}
