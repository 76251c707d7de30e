#include <ceres/tiny_solver.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fit_methods.hpp"
#include "support/waveform.hpp"

namespace atlas {
namespace {

constexpr int kUnknowns = 6;  // ln k, ln w_n, zeta, ln (F_s - F_k), F_k, time from the first onset to the first sample
using Vector = Eigen::Matrix<double, kUnknowns, 1>;

/// Residuals of a whole recording for ceres::TinySolver.
class WholeTrace {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kUnknowns };

  explicit WholeTrace(const slipfit::Recording& recording)
      : recording_(recording), step_s_(recording.duration_s() / static_cast<double>(recording.size() - 1)) {}

  [[nodiscard]] int NumResiduals() const { return static_cast<int>(recording_.size()); }

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    const auto count = static_cast<Eigen::Index>(recording_.size());
    Eigen::Map<Eigen::VectorXd> r(residuals, count);
    const auto slider = slipfit::Slider::create(std::exp(x[0]), std::exp(x[1]), x[2]);
    const auto friction = slipfit::Friction::create(x[4] + std::exp(x[3]), x[4]);
    const slipfit::SampleTimes times{x[5], step_s_, recording_.size()};
    const double speed = recording_.conditions().speed_m_per_s;
    const auto wave = slider && friction && x[5] >= 0.0
                          ? slipfit::damped_waveform_sensitivity(slider.value(), friction.value(), speed, times)
                          : std::nullopt;
    if (!wave) {  // outside the model: a wall that the solver steps back from
      r.setConstant(1e3);
      if (jacobian != nullptr) Eigen::Map<Eigen::MatrixXd>(jacobian, count, kUnknowns).setZero();
      return true;
    }
    r = Eigen::Map<const Eigen::VectorXd>(wave->force_N.data(), count) -
        Eigen::Map<const Eigen::VectorXd>(recording_.force().data(), count);
    if (jacobian == nullptr) return true;
    fill(*wave, slider.value(), friction.value(), times, Eigen::Map<Eigen::MatrixXd>(jacobian, count, kUnknowns));
    return true;
  }

 private:
  void fill(const slipfit::WaveformSensitivity& wave, const slipfit::Slider& slider, const slipfit::Friction& friction,
            slipfit::SampleTimes times, Eigen::Map<Eigen::MatrixXd> jacobian) const {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, slipfit::kSensitivityParameters, Eigen::RowMajor>;
    const Eigen::Map<const Rows> gradient(wave.gradient.data(), jacobian.rows(), slipfit::kSensitivityParameters);
    jacobian.col(0) = slider.stiffness_N_per_m() * gradient.col(slipfit::kStiffness);
    jacobian.col(1) = slider.natural_frequency_rad_per_s() * gradient.col(slipfit::kNaturalFrequency);
    jacobian.col(2) = gradient.col(slipfit::kDampingRatio);
    jacobian.col(3) = friction.difference_N() * gradient.col(slipfit::kStaticFriction);
    jacobian.col(4) = gradient.col(slipfit::kStaticFriction) + gradient.col(slipfit::kKineticFriction);
    const double ahead_s = 1e-6 * step_s_;
    times.begin_s += ahead_s;
    const auto later = slipfit::damped_waveform(slider, friction, recording_.conditions().speed_m_per_s,
                                                slipfit::ForceView::Spring, times);
    jacobian.col(5) = (Eigen::Map<const Eigen::VectorXd>(later->data(), jacobian.rows()) -
                       Eigen::Map<const Eigen::VectorXd>(wave.force_N.data(), jacobian.rows())) /
                      ahead_s;
  }

  const slipfit::Recording& recording_;
  double step_s_;
};

Vector true_vector(const Scene& scene) {
  Vector x;
  x << std::log(scene.slider.stiffness_N_per_m()), std::log(scene.slider.natural_frequency_rad_per_s()),
      scene.slider.damping_ratio(), std::log(scene.friction.difference_N()), scene.friction.kinetic_N(), scene.begin_s;
  return x;
}

/// Standard errors of the six for unit noise.
Vector unit_errors(const WholeTrace& trace, const Vector& x) {
  const auto count = static_cast<Eigen::Index>(trace.NumResiduals());
  Eigen::VectorXd residuals(count);
  Eigen::MatrixXd jacobian(count, kUnknowns);
  trace(x.data(), residuals.data(), jacobian.data());
  const Vector size = jacobian.colwise().norm().transpose().cwiseMax(1e-300);
  jacobian *= size.cwiseInverse().asDiagonal();
  const Eigen::Matrix<double, kUnknowns, kUnknowns> normal = jacobian.transpose() * jacobian;
  return (normal.inverse().diagonal().cwiseSqrt().array() / size.array()).matrix();
}

std::array<double, kFitParameters> in_units(const Vector& errors, const std::array<double, kFitParameters>& values) {
  return {errors[0] * values[kStiffnessOf], errors[1] * values[kFrequencyOf], errors[2], errors[3] * values[kDropOf]};
}

}  // namespace

std::array<double, kFitParameters> truth_of(const Scene& scene) {
  return {scene.slider.stiffness_N_per_m(), scene.slider.natural_frequency_rad_per_s(), scene.slider.damping_ratio(),
          scene.friction.difference_N()};
}

std::array<double, kFitParameters> whole_trace_bound(const Scene& scene) {
  const Vector errors = scene.noise_N * unit_errors(WholeTrace(scene.recording), true_vector(scene));
  return in_units(errors, truth_of(scene));
}

FitAnswer fit_whole_trace(const Scene& scene, double start_error, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto off = [&] { return (random() & 1U) != 0U ? start_error : -start_error; };
  Vector x = true_vector(scene);
  for (const int i : {0, 1, 3}) x[i] += off();
  x[2] *= 1.0 + off();
  const WholeTrace trace(scene.recording);
  ceres::TinySolver<WholeTrace> solver;
  solver.options.max_num_iterations = 100;
  solver.Solve(trace, &x);
  const auto samples = static_cast<double>(trace.NumResiduals());
  const double noise_N = std::sqrt(2.0 * solver.summary.final_cost / (samples - kUnknowns));
  const std::array<double, kFitParameters> values{std::exp(x[0]), std::exp(x[1]), x[2], std::exp(x[3])};
  const auto errors = in_units(noise_N * unit_errors(trace, x), values);
  FitAnswer answer;
  for (std::size_t i = 0; i < kFitParameters; ++i) {
    const slipfit::Interval interval{values[i] - 1.96 * errors[i], values[i] + 1.96 * errors[i]};
    answer.estimates[i] = {values[i], errors[i], interval, {}};
    answer.sure[i] = true;
  }
  return answer;
}

}  // namespace atlas
