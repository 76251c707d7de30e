// What a comparison makes of fit documents.
#include "slipfit/compare.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "slipfit/report/comparison.hpp"
#include "support/recordings.hpp"

using namespace slipfit;
using nlohmann::json;

namespace {

json parameter(double value, double se, const char* status = "identified") {
  return {
      {"value", value}, {"se", se}, {"ci95", {value - 1.97 * se, value + 1.97 * se}}, {"status", status}, {"note", ""}};
}

json document(double stiffness, double speed = 0.01) {
  return {{"schema", "slipfit.fit/1"},
          {"id", "run"},
          {"status", "stick_slip"},
          {"recording", {{"file", "run.csv"}, {"speed_m_per_s", speed}, {"normal_force_N", 5.0}, {"group", "dry"}}},
          {"frequency", {{"value_Hz", 10.0}, {"se_Hz", 0.1}, {"ci95_Hz", {9.8, 10.2}}}},
          {"parameters", {{"stiffness_N_per_m", parameter(stiffness, 10.0)}}},
          {"coefficients", nullptr}};
}

ComparedFit fit_of(const json& content) {
  return compared_fit(content.dump()).value();
}

const QuantityComparison& of(const Comparison& comparison, std::string_view key) {
  for (const QuantityComparison& quantity : comparison.quantities) {
    if (quantity.quantity.key == key) return quantity;
  }
  FAIL("no quantity " << key);
  throw;
}

}  // namespace

TEST_CASE("one recording on each side: standard errors, and that repeats are not known") {
  const Comparison comparison = compare({"a", {fit_of(document(1000.0))}}, {"b", {fit_of(document(1100.0))}});
  const QuantityComparison& stiffness = of(comparison, "stiffness_N_per_m");
  CHECK(*stiffness.difference.value == Approx(100.0));
  CHECK(*stiffness.difference.standard_error == Approx(std::sqrt(200.0)));
  CHECK(*stiffness.ratio.value == Approx(1.1));
  CHECK(stiffness.method == ComparisonMethod::StandardErrors);
  CHECK(stiffness.differs());
  CHECK(*stiffness.p_adjusted == Approx(2.0 * *stiffness.p_value));  // with the frequency
  CHECK(*of(comparison, "frequency_Hz").p_value == Approx(1.0));
  CHECK(test::warns(comparison.warnings, "scatter_unknown"));
  CHECK_FALSE(test::warns(comparison.warnings, "speeds_differ"));
  CHECK(comparison.a.fits.front().group == "dry");
}

TEST_CASE("cycles do not count, recordings do") {
  const std::vector<double> a{1000.0, 1100.0, 1200.0};
  const std::vector<double> b{1050.0, 1150.0, 1250.0};
  ComparisonSide side_a{"a", {}}, side_b{"b", {}};
  for (const double k : a) side_a.fits.push_back(fit_of(document(k)));
  for (const double k : b) side_b.fits.push_back(fit_of(document(k)));
  const Comparison comparison = compare(side_a, side_b);
  const QuantityComparison& stiffness = of(comparison, "stiffness_N_per_m");
  CHECK(stiffness.method == ComparisonMethod::Welch);
  CHECK(stiffness.a.recordings == 3);
  CHECK(*stiffness.difference.standard_error == Approx(100.0 * std::sqrt(2.0 / 3.0)));
  CHECK(*stiffness.p_value > 0.3);
  CHECK_FALSE(test::warns(comparison.warnings, "scatter_unknown"));
  side_b.fits.resize(1);
  CHECK(of(compare(side_a, side_b), "stiffness_N_per_m").method == ComparisonMethod::ScatterOfA);
  CHECK(test::warns(compare(side_a, side_b).warnings, "scatter_of_one_side"));
}

TEST_CASE("a quantity that one side lacks is null with a reason") {
  json bounded = document(1000.0);
  bounded["parameters"]["friction_difference_N"] = parameter(2.0, 0.5, "bounded");
  bounded["parameters"]["damping_ratio"] = parameter(0.1, 0.0, "fixed");
  json known = document(1000.0);
  known["parameters"]["friction_difference_N"] = parameter(2.0, 0.1);
  known["parameters"]["mass_kg"] = parameter(0.02, 0.001);
  const Comparison comparison = compare({"a", {fit_of(bounded)}}, {"b", {fit_of(known)}});
  const auto reason = [&comparison](const char* key) {
    const QuantityComparison& quantity = of(comparison, key);
    CHECK_FALSE(quantity.difference.value);
    CHECK_FALSE(quantity.ratio.value);
    CHECK_FALSE(quantity.p_value);
    CHECK_FALSE(quantity.p_adjusted);
    CHECK_FALSE(quantity.method);
    return quantity.difference.note;
  };
  CHECK_THAT(reason("friction_difference_N"), Catch::Contains("not known in A") && Catch::Contains("bounded"));
  CHECK_THAT(reason("damping_ratio"), Catch::Contains("fixed"));
  CHECK_THAT(reason("mass_kg"), Catch::Contains("not known in A"));
  CHECK(comparison.quantities.size() == 5);  // these, k and the frequency: what neither side has is left out
}

TEST_CASE("other speeds, loads and kinds of motion are said") {
  json other = document(1000.0, 0.02);
  other["recording"]["normal_force_N"] = 7.0;
  other["status"] = "steady_sliding";
  const Comparison comparison = compare({"a", {fit_of(document(1000.0))}}, {"b", {fit_of(other)}});
  for (const char* const code : {"speeds_differ", "loads_differ", "motions_differ"})
    CHECK(test::warns(comparison.warnings, code));
}

TEST_CASE("a zero that some recordings lack is said") {
  json zeroed = document(1000.0);
  zeroed["recording"]["zero_force_N"] = 0.1;
  json unknown = document(1000.0);
  unknown["recording"]["zero_force_N"] = nullptr;
  const auto warns_of = [](const json& one, const json& other) {
    return test::warns(compare({"a", {fit_of(one)}}, {"b", {fit_of(other)}}).warnings, "zeros_differ");
  };
  CHECK(warns_of(zeroed, unknown));
  CHECK_FALSE(warns_of(zeroed, zeroed));
  CHECK_FALSE(warns_of(unknown, unknown));
}

TEST_CASE("a recording that counts twice is said") {
  json first = document(1000.0);
  first["recording"]["input_digest"] = "xxh128:1";
  first["recording"]["sliding_s"] = {0.0, 1.0};
  json second = first;
  second["recording"]["sliding_s"] = {1.0, 2.0};
  const ComparedFit run = fit_of(first);
  CHECK(test::warns(compare({"a", {run, run}}, {"b", {fit_of(document(1000.0))}}).warnings, "recording_repeated"));
  CHECK(test::warns(compare({"a", {run}}, {"b", {run}}).warnings, "recording_repeated"));
  CHECK_FALSE(test::warns(compare({"a", {run}}, {"b", {fit_of(second)}}).warnings, "recording_repeated"));
}

TEST_CASE("the document of a comparison has the keys of its schema, and text and page agree with it") {
  const Comparison comparison = compare({"dry", {fit_of(document(1000.0))}}, {"<wet>", {fit_of(document(1500.0))}});
  const json result = json::parse(to_json(comparison));
  CHECK(result["schema"] == "slipfit.compare/1");
  const json& stiffness = result["quantities"]["stiffness_N_per_m"];
  CHECK(stiffness["difference"]["value"] == 500.0);
  CHECK(stiffness["difference"]["ci95"].size() == 2);
  CHECK(stiffness["ratio"]["value"] == 1.5);
  CHECK(stiffness["p_value"].get<double>() < 1e-6);
  CHECK(stiffness["method"] == "standard_errors");
  CHECK(stiffness["a"]["status"] == "identified");
  CHECK(result["a"]["recordings"][0]["speed_m_per_s"] == 0.01);
  CHECK_THAT(to_text(comparison), Catch::Contains("A and B differ in 1 of 2 quantities: tangential stiffness k"));
  const std::string page = to_html(comparison, {});
  CHECK_THAT(page, Catch::Contains("differ in 1 of 2") && Catch::Contains("&lt;wet&gt;") &&
                       Catch::Contains("Results of fits contain no traces") && !Catch::Contains("<wet>"));
}

TEST_CASE("a file that is not a fit document is refused") {
  for (const char* const text : {"", "{}", "[1]", "{\"schema\":\"slipfit.predict/1\"}"}) {
    CHECK(compared_fit(text).error().code == "bad_document");
  }
  CHECK(compared_fit(R"({"schema":"slipfit.fit/1","parameters":[1]})", "a.json").error().message ==
        "'a.json': parameters is [1], expected an object");
  // Of another shape inside: nothing is known, and nothing breaks.
  const ComparedFit odd = fit_of({{"schema", "slipfit.fit/1"}, {"frequency", 3}, {"recording", "x"}});
  CHECK(compare({"a", {odd}}, {"b", {odd}}).quantities.empty());
}
