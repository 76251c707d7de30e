#include "core/parallel.hpp"

#include <catch2/catch.hpp>

TEST_CASE("results of parallel work stand in the order of the indices") {
  const std::vector<std::size_t> squares = slipfit::in_parallel(100, [](std::size_t i) { return i * i; });
  REQUIRE(squares.size() == 100);
  for (std::size_t i = 0; i < squares.size(); ++i) CHECK(squares[i] == i * i);
  CHECK(slipfit::in_parallel(0, [](std::size_t i) { return i; }).empty());
}
