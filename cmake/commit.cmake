# cmake -DSOURCE=FOLDER -DOUTPUT=FILE.hpp -P commit.cmake: kCommit, the commit that the sources were checked out at; empty without git.
execute_process(COMMAND git -C "${SOURCE}" rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  set(commit "")
endif()
file(WRITE "${OUTPUT}" "#pragma once

namespace slipfit {

inline constexpr const char* kCommit = \"${commit}\";

}  // namespace slipfit
")
