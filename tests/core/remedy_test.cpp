#include <catch2/catch.hpp>

#include "slipfit/core/remedy.hpp"

using slipfit::remedy_of;

TEST_CASE("a remedy is what the message asks for") {
  CHECK(remedy_of({"no_speed", "run7.csv: no speed; give the driving speed with --speed"}) ==
        "give the driving speed with --speed");
  CHECK(
      remedy_of({"part_empty", "run7.csv: rows 8:9 hold 0 samples; the file has 4 rows: choose others with --rows"}) ==
      "choose others with --rows");
  CHECK(remedy_of({"time_runs_backwards", "a.csv:3: is it the time? Choose another with --time-column, or a part"}) ==
        "Choose another with --time-column, or a part");
  CHECK(remedy_of({"bad_number", "--speed: bad value 'fast', expected a number with a unit"}) ==
        "expected a number with a unit");
}

TEST_CASE("the table of errors gives the remedy of a message without a request") {
  CHECK(remedy_of({"window_empty", "run7.csv: the window 50:60 s holds 0 samples; the clock runs from 0 to 2 s"}) ==
        "another --window");
  CHECK(remedy_of({"no_such_code", "run7.csv: nothing is known; the rest neither"}).empty());
}
