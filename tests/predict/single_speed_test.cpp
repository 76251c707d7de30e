// Predictions from one speed allow for what one speed cannot show. docs/model.md section 13
#include "slipfit/predict/single_speed.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "slipfit/predict/prediction.hpp"

using namespace slipfit;

namespace {

constexpr double kSpeed_m_per_s = 0.01;
constexpr std::array kAllIdentified{ParameterStatus::Identified, ParameterStatus::Identified,
                                    ParameterStatus::Identified, ParameterStatus::Identified};

ModelEstimate fitted() {
  ModelEstimate estimate;
  estimate.stiffness_N_per_m = 1000.0;
  estimate.natural_frequency_rad_per_s = 200.0;
  estimate.damping_ratio = 0.05;
  estimate.friction_difference_N = 2.0;
  for (std::size_t i = 0; i < 4; ++i) estimate.covariance[i][i] = 1e-6;
  estimate.degrees_of_freedom = 1e9;
  estimate.damping_identified = true;
  return estimate;
}

PredictedMotion predicted(const ModelEstimate& estimate, double speed_m_per_s) {
  const std::array<double, 1> speeds{speed_m_per_s};
  return predict_at({estimate, true, Estimate{4.0, 0.01, {}, {}}}, speeds).rows.front();
}

/// Half of the logarithm of the ratio of the ends.
double half_width(const Estimate& estimate) {
  REQUIRE(estimate.ci95);
  return 0.5 * std::log(estimate.ci95->high / estimate.ci95->low);
}

double spacing_width(const ModelEstimate& estimate, double speed_m_per_s) {
  return half_width(predicted(estimate, speed_m_per_s).periodic_displacement_m);
}

}  // namespace

TEST_CASE("one speed: the interval at that speed is the fit's, and grows with the ratio of the speeds") {
  const ModelEstimate one = from_single_speed(fitted(), kSpeed_m_per_s, kAllIdentified);
  CHECK(spacing_width(one, kSpeed_m_per_s) == Approx(spacing_width(fitted(), kSpeed_m_per_s)));
  CHECK(predicted(one, kSpeed_m_per_s).note.empty());
  // At lambda of 40 and more the spacing is nearly 2 (F_s - F_k) / k.
  for (const double ratio : {0.1, 0.5, 2.0}) {
    CAPTURE(ratio);
    const double expected = std::hypot(0.33, 0.15) * std::abs(std::log(ratio));
    CHECK(spacing_width(one, kSpeed_m_per_s * ratio) == Approx(expected).epsilon(0.1));
    CHECK(predicted(one, kSpeed_m_per_s * ratio).note.find("one speed was measured") != std::string::npos);
  }
}

TEST_CASE("one speed: static friction that ages by 4 % a decade is inside the interval at twenty times the speed") {
  // F_s = 6 N falls by 4 % for each decade of speed, F_s - F_k = 2 N with it.
  ModelEstimate aged = fitted();
  const double fast_m_per_s = 20.0 * kSpeed_m_per_s;
  aged.friction_difference_N -= 0.04 * 6.0 * std::log10(fast_m_per_s / kSpeed_m_per_s);
  const double truth_m = *predicted(aged, fast_m_per_s).periodic_displacement_m.value;
  const Estimate blind = predicted(fitted(), fast_m_per_s).periodic_displacement_m;
  const Estimate allowing =
      predicted(from_single_speed(fitted(), kSpeed_m_per_s, kAllIdentified), fast_m_per_s).periodic_displacement_m;
  REQUIRE(blind.ci95);
  REQUIRE(allowing.ci95);
  CHECK(truth_m < blind.ci95->low);
  CHECK(allowing.ci95->low < truth_m);
  CHECK(truth_m < allowing.ci95->high);
}

TEST_CASE("one speed: weak and conditional parameters widen the intervals at other speeds, fixed ones do not") {
  const double fast_m_per_s = 2.0 * kSpeed_m_per_s;
  std::array<ParameterStatus, 4> statuses = kAllIdentified;
  const double identified = spacing_width(from_single_speed(fitted(), kSpeed_m_per_s, statuses), fast_m_per_s);
  for (const std::size_t parameter : {0U, 3U}) {  // at lambda of 20 the spacing hardly depends on w_n
    CAPTURE(parameter);
    for (const ParameterStatus status : {ParameterStatus::Weak, ParameterStatus::Conditional}) {
      statuses = kAllIdentified;
      statuses.at(parameter) = status;
      const ModelEstimate doubtful = from_single_speed(fitted(), kSpeed_m_per_s, statuses);
      CHECK(spacing_width(doubtful, fast_m_per_s) > 1.01 * identified);
      CHECK(spacing_width(doubtful, kSpeed_m_per_s) == Approx(spacing_width(fitted(), kSpeed_m_per_s)));
    }
    statuses.at(parameter) = ParameterStatus::Fixed;
    CHECK(spacing_width(from_single_speed(fitted(), kSpeed_m_per_s, statuses), fast_m_per_s) == Approx(identified));
  }
}

TEST_CASE("one speed: the critical speed allows for its distance, a sweep's does not change") {
  const Estimate of_fit = predict_at({fitted(), true, std::nullopt}, {}).critical_speed_m_per_s;
  const ModelEstimate one = from_single_speed(fitted(), kSpeed_m_per_s, kAllIdentified);
  const Estimate of_one = predict_at({one, true, std::nullopt}, {}).critical_speed_m_per_s;
  CHECK(*of_one.value == Approx(*of_fit.value));
  CHECK(half_width(of_one) > 10.0 * half_width(of_fit));
  ModelEstimate sweep = fitted();
  sweep.reach = SpeedReach{0.5 * kSpeed_m_per_s, 2.0 * kSpeed_m_per_s, 0.0};
  CHECK(spacing_width(sweep, 4.0 * kSpeed_m_per_s) == Approx(spacing_width(fitted(), 4.0 * kSpeed_m_per_s)));
}
