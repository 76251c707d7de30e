#include "analysis/audit.hpp"
#include "analysis/rules.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.hpp"

namespace slipfit {
namespace {

Recording recording_at(double speed_m_per_s, std::optional<Estimate> moved_m_per_s = {}) {
  Conditions conditions;
  conditions.speed_m_per_s = speed_m_per_s;
  Provenance provenance;
  provenance.moved_m_per_s = std::move(moved_m_per_s);
  return Recording::create({0.0, 1.0, 2.0}, {1.0, 2.0, 1.0}, conditions, provenance).value();
}

/// Stick-slip with k = 5000 N/m, m = 6 g, and sticks of this slope over V.
Analysis analysis_with(double stick_stiffness_N_per_m) {
  FitResult fit;
  fit.parameters = {{ParameterId::Stiffness, symmetric(5000.0, 2.0), ParameterStatus::Identified},
                    {ParameterId::FrictionDifference, symmetric(1.0, 0.01), ParameterStatus::Conditional},
                    {ParameterId::NaturalFrequency, symmetric(900.0, 1.0), ParameterStatus::Identified},
                    {ParameterId::Mass, symmetric(6e-3, 1e-5), ParameterStatus::Identified}};
  Analysis analysis;
  analysis.motion = MotionClass::StickSlip;
  analysis.fit = fit;
  analysis.cycles.slip_time_s = 4e-3;
  analysis.cycles.stick_time_s = 0.04;
  analysis.cycles.stick_stiffness = symmetric(stick_stiffness_N_per_m, 3.0);
  return analysis;
}

std::vector<AuditPair> own_audit(const Recording& recording, const Analysis& analysis) {
  return audit_of(recording, analysis, *analysis.fit);
}

const Parameter& of(const FitResult& fit, ParameterId id) {
  REQUIRE(fit.find(id) != nullptr);
  return *fit.find(id);
}

/// The pairs of a joint fit over recordings whose sticks have these slopes over V.
std::vector<AuditPair> joint_pairs(const FitResult& joint,
                                   const std::vector<std::pair<std::string, double>>& stick_stiffness_N_per_m) {
  std::vector<AuditPair> pairs;
  for (const auto& [id, slope] : stick_stiffness_N_per_m) {
    const std::vector<AuditPair> more = joint_audit_of({id, recording_at(0.01)}, analysis_with(slope), joint);
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  return pairs;
}

}  // namespace

TEST_CASE("k that the slope of the sticks contradicts is not identified, and its interval includes both") {
  const Recording recording = recording_at(0.01);
  const Analysis analysis = analysis_with(4000.0);
  const std::vector<AuditPair> pairs = own_audit(recording, analysis);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs.front().pair == "stiffness_and_sticks");
  CHECK(pairs.front().contradicts);
  const FitResult fit = with_audit(*analysis.fit, pairs);
  CHECK(of(fit, ParameterId::Stiffness).status == ParameterStatus::Weak);
  CHECK(of(fit, ParameterId::Stiffness).estimate.ci95->low == Approx(4000.0));
  CHECK(of(fit, ParameterId::Mass).estimate.ci95->low == Approx(4.8e-3));
  CHECK(of(fit, ParameterId::NaturalFrequency).status == ParameterStatus::Identified);
  CHECK(sentence_of(pairs.front()) ==
        "the stiffness k of the fit is 5000 N/m, the slope of the sticks over the speed is 4000 N/m");
}

TEST_CASE("values that agree within 4 standard errors, or 1 %, contradict nothing") {
  const Recording recording = recording_at(0.01);
  for (const double slope : {5000.0, 5012.0, 5045.0, 4955.0}) {  // 13.9 N/m are 4 errors, 50 are 1 %
    const std::vector<AuditPair> pairs = own_audit(recording, analysis_with(slope));
    REQUIRE(pairs.size() == 1);
    CHECK_FALSE(pairs.front().contradicts);
  }
}

TEST_CASE("the slope of the sticks is compared without the drift that the fit has") {
  Analysis analysis = analysis_with(5200.0);
  analysis.fit->level_trend.in_sticks_per_s = 2.0;  // 200 N/m at 10 mm/s
  const std::vector<AuditPair> pairs = own_audit(recording_at(0.01), analysis);
  REQUIRE(pairs.size() == 1);
  CHECK(*pairs.front().second.value == Approx(5000.0));
  CHECK_FALSE(pairs.front().contradicts);
}

TEST_CASE("a recording of a joint fit is compared with the shared k at its speed") {
  FitResult joint = *analysis_with(5000.0).fit;
  joint.parameters.push_back({ParameterId::StiffnessExponent, symmetric(0.1, 0.001), ParameterStatus::Identified});
  joint.estimate = ModelEstimate{};
  joint.estimate->stiffness_trend = StiffnessTrend{0.1, 0.01};
  const double grown = 5000.0 * std::pow(3.0, 0.1);
  const std::vector<AuditPair> agree = joint_audit_of({"fast", recording_at(0.03)}, analysis_with(grown), joint);
  REQUIRE(agree.size() == 1);
  CHECK(*agree.front().first.value == Approx(grown));
  CHECK_FALSE(agree.front().contradicts);
  CHECK(joint_audit_of({"fast", recording_at(0.03)}, analysis_with(5000.0), joint).front().contradicts);
}

TEST_CASE("a shared k that one recording contradicts is not identified, and the warning names the recording") {
  const FitResult joint = *analysis_with(5000.0).fit;
  const std::vector<AuditPair> pairs = joint_pairs(joint, {{"slow", 5000.0}, {"middle", 4500.0}, {"fast", 4000.0}});
  REQUIRE(pairs.size() == 3);
  const FitResult fit = with_audit(joint, pairs);
  CHECK(of(fit, ParameterId::Stiffness).status == ParameterStatus::Weak);
  CHECK(of(fit, ParameterId::Stiffness).estimate.ci95->low == Approx(4000.0));
  CHECK(of(fit, ParameterId::Stiffness).estimate.note.find("recording 'fast'") != std::string::npos);
  const Warnings warnings = warn_of(pairs);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings.front().message.find("recording 'middle'") == 0);
}

TEST_CASE("one recording that contradicts a shared k lowers its status, and the interval stays that of the others") {
  const FitResult joint = *analysis_with(5000.0).fit;
  const std::vector<AuditPair> pairs = joint_pairs(joint, {{"a", 5000.0}, {"b", 5003.0}, {"wrong", 300000.0}});
  const FitResult fit = with_audit(joint, pairs);
  CHECK(of(fit, ParameterId::Stiffness).status == ParameterStatus::Weak);
  CHECK(of(fit, ParameterId::Stiffness).estimate.ci95->high < 5010.0);
  REQUIRE(warn_of(pairs).size() == 1);
  CHECK(warn_of(pairs).front().message.find("check this one") != std::string::npos);
}

TEST_CASE("k by the displacement makes k conditional where the two speeds differ") {
  const Estimate moved{0.0095, 1e-6, std::nullopt, {}};
  const Analysis analysis = analysis_with(5000.0);
  const std::vector<AuditPair> pairs = own_audit(recording_at(0.01, moved), analysis);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs.back().pair == "speed_and_displacement");
  const FitResult fit = with_audit(*analysis.fit, pairs);
  CHECK(of(fit, ParameterId::Stiffness).status == ParameterStatus::Conditional);
  CHECK(of(fit, ParameterId::Stiffness).estimate.ci95->high == Approx(5000.0 / 0.95));
}

TEST_CASE("the measured spacing includes the one at the speed of the displacement") {
  Derived derived;
  derived.pattern_spacing_m = symmetric(4e-4, 1e-6);
  derived.impulse_rate_per_m = symmetric(2500.0, 6.0);
  const std::vector<AuditPair> pairs =
      own_audit(recording_at(0.01, Estimate{0.02, 1e-6, std::nullopt, {}}), analysis_with(5000.0));
  const Derived audited = with_audit(derived, pairs);
  CHECK(audited.pattern_spacing_m.ci95->high == Approx(8e-4));
  CHECK(audited.impulse_rate_per_m.ci95->low == Approx(1250.0));
}

TEST_CASE("k includes the slope of sticks that differ from most") {
  Analysis analysis = analysis_with(5000.0);
  analysis.cycles.other_sticks = {9, symmetric(4500.0, 3.0)};
  const std::vector<AuditPair> pairs = own_audit(recording_at(0.01), analysis);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs.back().pair == "stiffness_and_other_sticks");
  const FitResult fit = with_audit(*analysis.fit, pairs);
  CHECK(of(fit, ParameterId::Stiffness).status == ParameterStatus::Weak);
  CHECK(of(fit, ParameterId::Stiffness).estimate.ci95->low == Approx(4500.0));
}

TEST_CASE("short sticks have no slope to compare") {
  Analysis analysis = analysis_with(4000.0);
  analysis.cycles.stick_time_s = 4e-3;
  CHECK(own_audit(recording_at(0.01), analysis).empty());
}

TEST_CASE("only stick-slip with a fit is audited") {
  Analysis analysis = analysis_with(4000.0);
  analysis.motion = MotionClass::Undetermined;
  CHECK(own_audit(recording_at(0.01), analysis).empty());
}

TEST_CASE("with a warning about the speed or the units, k, m and c are conditional") {
  const FitResult fit = *analysis_with(5000.0).fit;
  for (const char* const code : {"speed_differs_from_displacement", "speed_differs", "implausible_units"}) {
    CAPTURE(code);
    const FitResult limited = limited_by({{code, ""}}, fit);
    CHECK(of(limited, ParameterId::Stiffness).status == ParameterStatus::Conditional);
    CHECK(of(limited, ParameterId::Mass).status == ParameterStatus::Conditional);
    CHECK(of(limited, ParameterId::NaturalFrequency).status == ParameterStatus::Identified);
  }
  CHECK(of(limited_by({{"gaps", ""}}, fit), ParameterId::Stiffness).status == ParameterStatus::Identified);
}

}  // namespace slipfit
