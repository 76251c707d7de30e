// The number of threads changes no digit of a fit.

#include <catch2/catch.hpp>
#include <string>

#include "core/parallel.hpp"
#include "scene.hpp"
#include "slipfit/report/json.hpp"

using namespace slipfit;

namespace {

/// The whole document but the seconds that it took.
std::string document_of(const Recording& recording, const FitOptions& options) {
  Analysis analysis = analyze_and_fit(recording, options);
  analysis.timing = {};
  return to_json(recording, analysis);
}

std::string document_on_one_thread(const Recording& recording, const FitOptions& options) {
  constexpr std::size_t kMoreThanProcessors = 100000;
  share_processors(kMoreThanProcessors);
  std::string document = document_of(recording, options);
  share_processors(1);
  return document;
}

}  // namespace

TEST_CASE("a large recording is fitted alike on one thread and on several") {
  Scene s;
  s.cycles = 3000.0;  // more than cycle_data.hpp and events.cpp ask for
  s.noise = 0.02;
  s.jitter = 0.03;
  s.drift_over_drop = 0.5;
  s.hum = 0.05;
  const Recording recording = record(s);
  REQUIRE(recording.size() > 250000);
  FitOptions options;
  SECTION("damped") {}
  SECTION("friction that weakens") {
    options.tier = Tier::Weakening;
  }
  const std::string document = document_of(recording, options);
  CHECK(document == document_of(recording, options));
  CHECK(document == document_on_one_thread(recording, options));
}
