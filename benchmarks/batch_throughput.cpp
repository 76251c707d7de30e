// Throughput, memory and overhead of slipfit batch. docs/validation.md quotes what it prints.
// batch_throughput [RECORDINGS [SAMPLES]]

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "slipfit/batch/batch.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/json.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kSpeed_m_per_s = 0.02;
constexpr double kSampleRate_Hz = 1000.0;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One recording a row, each with its own seed and stiffness; returns the manifest.
fs::path write_recordings(const fs::path& folder, std::size_t recordings, std::size_t samples) {
  std::ofstream manifest(folder / "runs.csv");
  manifest << "id,file,speed_m_per_s\n";
  for (std::size_t i = 0; i < recordings; ++i) {
    const double stiffness = 800.0 + static_cast<double>(i % 17) * 25.0;
    const auto slider = slipfit::Slider::create(stiffness, 200.0, 0.05).value();
    const auto friction = slipfit::Friction::create(6.0, 4.0).value();
    slipfit::SimulationOptions options;
    options.duration_s = static_cast<double>(samples) / kSampleRate_Hz;
    options.sample_rate_Hz = kSampleRate_Hz;
    options.noise_rms_N = 0.02;
    options.static_friction_sd_N = 0.05;
    options.seed = i + 1;
    const auto trace = slipfit::simulate(slider, friction, kSpeed_m_per_s, options);
    std::ofstream(folder / fmt::format("r{}.csv", i)) << slipfit::trace_to_csv(trace, "benchmark");
    manifest << fmt::format("r{0},r{0}.csv,{1}\n", i, kSpeed_m_per_s);
  }
  return folder / "runs.csv";
}

struct Measured {
  double seconds = 0.0;
  double processor_s = 0.0;  ///< of all threads: does not depend on who else uses the machine
  double megabytes = 0.0;    ///< largest resident size
};

/// In a process of its own, whose memory is its own.
template <class Work>
std::optional<Measured> measure(const Work& work) {
  const Clock::time_point start = Clock::now();
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work() ? 0 : 1);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  if (status != 0) return std::nullopt;
  const auto processor_s = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return Measured{seconds_since(start), processor_s(usage.ru_utime) + processor_s(usage.ru_stime),
                  static_cast<double>(usage.ru_maxrss) / 1024.0};
}

bool run_batch(const fs::path& manifest, const fs::path& folder, std::size_t jobs) {
  slipfit::BatchOptions options;
  options.manifest = manifest;
  options.folder = folder;
  options.jobs = jobs;
  return slipfit::run_batch(options).ok();
}

/// What a batch cannot do without: read, fit, document.
bool run_bare(const fs::path& manifest) {
  auto entries = slipfit::read_manifest_group(manifest, std::nullopt);
  std::size_t bytes = 0;
  for (const slipfit::ManifestEntry& entry : entries.value()) {
    const auto recording = slipfit::read_recording(entry.file, entry.conditions);
    bytes += slipfit::to_json(recording.value(), slipfit::analyze_and_fit(recording.value())).size();
  }
  return bytes > 0;
}

void print(const std::string& name, const std::optional<Measured>& measured, std::size_t recordings) {
  if (!measured) {
    fmt::print("{},failed,,,\n", name);
    return;
  }
  const auto count = static_cast<double>(recordings);
  fmt::print("{},{:.3f},{:.1f},{:.3f},{:.1f}\n", name, measured->seconds, count / measured->seconds,
             1e3 * measured->processor_s / count, measured->megabytes);
}

/// A manifest whose files are all missing: what is left is the batch itself.
fs::path write_long_manifest(const fs::path& folder, std::size_t rows) {
  std::ofstream manifest(folder / "long.csv");
  manifest << "id,file,speed_m_per_s\n";
  for (std::size_t i = 0; i < rows; ++i) manifest << fmt::format("recording-{0},none/{0}.csv,0.01\n", i);
  return folder / "long.csv";
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t recordings = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 2000;
  const std::size_t samples = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 4000;
  constexpr std::size_t kLongRows = 1000000;
  std::string name = (fs::temp_directory_path() / "slipfit-batch-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) return 1;
  const fs::path folder = name;
  const fs::path manifest = write_recordings(folder, recordings, samples);
  fmt::print("# {} recordings of {} samples\nwhat,seconds,recordings_per_s,processor_ms_per_recording,resident_MB\n",
             recordings, samples);
  print("bare fit", measure([&] { return run_bare(manifest); }), recordings);
  for (const std::size_t jobs : {1U, 2U}) {
    const fs::path out = folder / fmt::format("out{}", jobs);
    print(fmt::format("batch --jobs {}", jobs), measure([&] { return run_batch(manifest, out, jobs); }), recordings);
  }
  const fs::path long_manifest = write_long_manifest(folder, kLongRows);
  print(fmt::format("{} rows of missing files --jobs 2", kLongRows),
        measure([&] { return run_batch(long_manifest, folder / "long", 2); }), kLongRows);
  fs::remove_all(folder);
  return 0;
}
