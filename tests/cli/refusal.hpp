#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace test {

/// Wrong usage: exit code 2, nothing on standard output, one line on standard error that holds `part`.
inline void check_refused(const std::vector<std::string>& arguments, const std::string& part) {
  const ProgramResult result = run_slipfit(arguments);
  CAPTURE(arguments, result.err);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK(lines_in(result.err) == 1);
  CHECK_THAT(result.err, Catch::StartsWith("slipfit: ") && Catch::Contains(part));
}

}  // namespace test
