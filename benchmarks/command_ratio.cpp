// How much a whole `slipfit fit` costs above the floor of reading the file at all: the time of the command, process
// start included, over the time of parsing its two columns with fast-cpp-csv-parser plus one FFTW transform of that
// length, both measured in turn in one run. The same in processor time, which other users of the machine move less but
// in which threads add up. Also the command's peak memory.
//   command_ratio SLIPFIT FILE.csv SPEED [RUNS]     FILE: a names row, then time and force separated by a comma

#include <csv.h>
#include <fcntl.h>
#include <fftw3.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double processor_ms(const rusage& usage) {
  const auto ms = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

double own_processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return processor_ms(usage);
}

struct Floor {
  double parse_ms = 0.0;
  double transform_ms = 0.0;
  double processor_ms = 0.0;
  std::size_t samples = 0;
};

Floor measure_floor(const std::string& file) {
  Floor floor;
  const double processor_start_ms = own_processor_ms();
  const auto start = Clock::now();
  std::vector<double> time_s;
  std::vector<double> force;
  io::CSVReader<2> reader(file);
  reader.next_line();
  double t = 0.0;
  double f = 0.0;
  while (reader.read_row(t, f)) {
    time_s.push_back(t);
    force.push_back(f);
  }
  floor.parse_ms = milliseconds_since(start);
  floor.samples = force.size();
  const auto middle = Clock::now();
  std::vector<double> spectrum(force.size() + 2);
  fftw_plan plan = fftw_plan_dft_r2c_1d(static_cast<int>(force.size()), force.data(),
                                        reinterpret_cast<fftw_complex*>(spectrum.data()), FFTW_ESTIMATE);
  fftw_execute(plan);
  floor.transform_ms = milliseconds_since(middle);
  floor.processor_ms = own_processor_ms() - processor_start_ms;
  fftw_destroy_plan(plan);
  return floor;
}

struct Command {
  double ms = 0.0;
  double processor_ms = 0.0;
  double peak_MB = 0.0;
  int code = -1;
};

Command run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  Command command;
  pid_t child = 0;
  const auto start = Clock::now();
  if (posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ) != 0) return command;
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  command.ms = milliseconds_since(start);
  command.processor_ms = processor_ms(usage);
  command.peak_MB = static_cast<double>(usage.ru_maxrss) / 1024.0;
  command.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  posix_spawn_file_actions_destroy(&actions);
  return command;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    fmt::print(stderr, "usage: command_ratio SLIPFIT FILE.csv SPEED [RUNS]\n");
    return 2;
  }
  const std::string file = words[2];
  const int runs = count > 4 ? std::atoi(words[4]) : 15;
  std::vector<double> parse;
  std::vector<double> transform;
  std::vector<double> whole;
  std::vector<double> ratios;
  std::vector<double> processor;
  std::vector<double> processor_ratios;
  double peak_MB = 0.0;
  std::size_t samples = 0;
  for (int i = 0; i <= runs; ++i) {
    const Floor floor = measure_floor(file);
    const Command command = run({words[1], "fit", file, "--speed", words[3], "--json"});
    if (command.code != 0) {
      fmt::print(stderr, "command_ratio: {} ended with code {}\n", words[1], command.code);
      return 1;
    }
    if (i == 0) continue;  // warm-up
    parse.push_back(floor.parse_ms);
    transform.push_back(floor.transform_ms);
    whole.push_back(command.ms);
    ratios.push_back(command.ms / (floor.parse_ms + floor.transform_ms));
    processor.push_back(command.processor_ms);
    processor_ratios.push_back(command.processor_ms / floor.processor_ms);
    peak_MB = std::max(peak_MB, command.peak_MB);
    samples = floor.samples;
  }
  fmt::print("samples {}\nparse_ms {:.1f}\ntransform_ms {:.1f}\nwhole_command_ms {:.1f}\nratio_median {:.2f}\n",
             samples, median(parse), median(transform), median(whole), median(ratios));
  fmt::print("processor_ms {:.1f}\nprocessor_ratio_median {:.2f}\n", median(processor), median(processor_ratios));
  fmt::print("ratio_range {:.2f} {:.2f}\npeak_memory_MB {:.1f}\nbytes_a_sample_above_60_MB {:.1f}\n",
             *std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end()), peak_MB,
             std::max(0.0, (peak_MB - 60.0) * 1048576.0 / static_cast<double>(samples)));
  return 0;
}
