#include "recordings.hpp"

#include <cmath>
#include <sstream>

#include "run_program.hpp"

namespace test {

std::string recording_csv(std::size_t samples, double sample_rate_Hz, const std::function<double(double)>& force_N) {
  std::ostringstream csv;
  csv.precision(12);
  csv << "time_s,force_N\n";
  for (std::size_t i = 0; i < samples; ++i) {
    const double time_s = static_cast<double>(i) / sample_rate_Hz;
    csv << time_s << ',' << force_N(time_s) << '\n';
  }
  return csv.str();
}

double sawtooth_N(double time_s, double period_s) {
  constexpr double kFall = 0.1;
  const double phase = time_s / period_s - std::floor(time_s / period_s);
  return 10.0 + 5.0 * (phase < 1.0 - kFall ? phase / (1.0 - kFall) : (1.0 - phase) / kFall);
}

std::string segments_csv() {
  constexpr int kSamples = 2000;
  std::ostringstream csv;
  csv.precision(12);
  csv << "time [s],force [N],speed [mm/s]\n";
  for (int i = 0; i < 3 * kSamples; ++i) {
    const double factor = std::exp2(i / kSamples);
    const double time_s = i / 500.0;
    csv << time_s << ',' << sawtooth_N(time_s, 0.4 / factor) << ',' << 10.0 * factor << '\n';
  }
  return csv.str();
}

std::string simulated_csv(const std::string& seed) {
  return run_slipfit({"simulate", "--stiffness",
                      "1000",     "--natural-frequency",
                      "200",      "--damping-ratio",
                      "0.05",     "--static-friction",
                      "6",        "--kinetic-friction",
                      "4",        "--speed",
                      "20mm/s",   "--duration",
                      "4",        "--sample-rate",
                      "1kHz",     "--noise",
                      "0.02",     "--jitter",
                      "0.05",     "--seed",
                      seed})
      .out;
}

}  // namespace test
