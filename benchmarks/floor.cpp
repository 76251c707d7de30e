// The floor of `slipfit fit`: parsing the two columns of a file with fast-cpp-csv-parser and one FFTW transform of that
// length. growth.py holds the command against it.
//   floor FILE.csv      FILE: a names row, then time and force separated by a comma; prints the second of two runs

#include <csv.h>
#include <fftw3.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// Samples, and milliseconds of parsing, of the transform, and of the processor.
std::string measure(const std::string& file) {
  const double processor_start_ms = processor_ms();
  const auto start = Clock::now();
  std::vector<double> time_s, force;
  io::CSVReader<2> reader(file);
  reader.next_line();
  double t = 0.0, f = 0.0;
  while (reader.read_row(t, f)) {
    time_s.push_back(t);
    force.push_back(f);
  }
  const double parse_ms = milliseconds_since(start);
  const auto middle = Clock::now();
  std::vector<double> spectrum(force.size() + 2);
  fftw_plan plan = fftw_plan_dft_r2c_1d(static_cast<int>(force.size()), force.data(),
                                        reinterpret_cast<fftw_complex*>(spectrum.data()), FFTW_ESTIMATE);
  fftw_execute(plan);
  const double transform_ms = milliseconds_since(middle);
  fftw_destroy_plan(plan);
  return fmt::format("{} {:.3f} {:.3f} {:.3f}", force.size(), parse_ms, transform_ms,
                     processor_ms() - processor_start_ms);
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return 2;
  measure(words[1]);
  fmt::print("{}\n", measure(words[1]));
}
