#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace test {

/// The document that slipfit writes to standard output, without a message.
inline nlohmann::json json_of(const std::vector<std::string>& arguments, const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = arguments;
  all.insert(all.end(), more.begin(), more.end());
  const ProgramResult result = run_slipfit(all);
  CAPTURE(all, result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  return nlohmann::json::parse(result.out);
}

}  // namespace test
