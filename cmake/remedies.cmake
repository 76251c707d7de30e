# cmake -DINPUT=docs/formats.md -DOUTPUT=FILE.hpp -P remedies.cmake: what to do about each error, from the tables of errors.
file(READ "${INPUT}" text)
string(FIND "${text}" "\n## Errors\n" begin)
string(SUBSTRING "${text}" ${begin} -1 text)
string(REGEX REPLACE "\\\\" "\\\\\\\\" text "${text}")
string(REGEX REPLACE "\"" "\\\\\"" text "${text}")
string(REPLACE ";" "<semicolon>" text "${text}")
# A row: | `code`, `code` | exit code | cause | remedy |
string(REGEX MATCHALL "\n\\| `[^\n]*" rows "${text}")
set(table "")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^\n\\| ([^|]*) \\|[^|]*\\|[^|]*\\| ([^|]*) \\|$" is_error "${row}")
  if(NOT is_error)
    continue()
  endif()
  string(REPLACE "`" "" remedy "${CMAKE_MATCH_2}")
  string(REGEX MATCHALL "[a-z0-9_]+" codes "${CMAKE_MATCH_1}")
  foreach(code IN LISTS codes)
    string(APPEND table "    Remedy{\"${code}\", \"${remedy}\"},\n")
  endforeach()
endforeach()
string(REPLACE "<semicolon>" ";" table "${table}")
file(WRITE "${OUTPUT}" "#pragma once

#include <array>
#include <string_view>

namespace slipfit {

struct Remedy {
  std::string_view code, remedy;
};

constexpr auto kRemedies = std::to_array<Remedy>({
${table}});

}  // namespace slipfit
")
