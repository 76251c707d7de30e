// Every recording of manifests, and recordings simulated here, each in the forms that must give the same answer. Prints
// what differs and a table by transform; exit 1 where a kind of motion or more than one answer in 200 differs.
//
//     invariance_study [--random COUNT] [MANIFEST...]

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "families.hpp"
#include "invariance.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"

using namespace slipfit;
using test::Scene;

namespace {

Scene scene_of(const std::string& name, const Recording& recording) {
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  Scene scene{name, {time_s.begin(), time_s.end()}, {force.begin(), force.end()}, recording.conditions()};
  // A coefficient or a stated zero has been applied: what the recording holds is the force of the file by now.
  scene.conditions.zero_force_N.reset();
  scene.conditions.quantity = ForceQuantity::Force_N;
  return scene;
}

/// Recordings that are not there or cannot be read are named and left out.
std::vector<Scene> scenes_of(const std::string& file) {
  std::vector<Scene> scenes;
  auto reader = ManifestReader::open(file);
  if (!reader) {
    fmt::print("skipped: {}\n", reader.error().message);
    return scenes;
  }
  ManifestReader manifest = std::move(reader).value();
  for (;;) {
    auto entry = manifest.next();
    if (!entry) fmt::print("skipped: {}\n", entry.error().message);
    if (!entry) continue;
    if (!entry.value()) return scenes;
    const ManifestEntry& row = *entry.value();
    const auto recording = read_recording(row.file, row.conditions, row.options);
    if (recording) {
      scenes.push_back(scene_of(row.id, recording.value()));
    } else {
      fmt::print("skipped: {}\n", recording.error().message);
    }
  }
}

std::vector<Scene> simulated_scenes(std::uint64_t count) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    scenes.push_back(test::random_scene(seed));
    scenes.back().described = fmt::format("random-{}", seed);
    scenes.back().conditions.zero_force_N.reset();
  }
  constexpr std::uint64_t kEach = 3;
  constexpr std::uint64_t kDefects = 8;
  for (const std::string& family : coverage::family_names()) {
    const std::uint64_t recordings = count == 0 ? 0 : family == "defect" ? kDefects : kEach;
    for (std::uint64_t index = 0; index < recordings; ++index) {
      const coverage::Scene scene = coverage::make_scene(family, index, 7);
      scenes.push_back(scene_of(fmt::format("{}-{}", family, index), scene.recording));
    }
  }
  return scenes;
}

struct Tally {
  int answers = 0, motions = 0, numbers = 0, known = 0, refused = 0;

  void add(const Tally& other) {
    answers += other.answers;
    motions += other.motions;
    numbers += other.numbers;
    known += other.known;
    refused += other.refused;
  }
  [[nodiscard]] int different() const { return motions + numbers + known + refused; }
};

struct Checked {
  std::vector<Tally> tallies;  ///< one a transform
  std::string report;          ///< a line for each difference
};

Checked check(const Scene& scene, std::uint64_t seed) {
  const std::vector<test::Transform> transforms = test::invariances(seed);
  Checked checked{std::vector<Tally>(transforms.size()), {}};
  Analysis plain;
  try {
    plain = test::analyse_as_read(scene);
  } catch (const std::exception& refusal) {
    checked.report = fmt::format("{}: not analysed: {}\n", scene.described, refusal.what());
    return checked;
  }
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    Tally& tally = checked.tallies[i];
    tally.answers = 1;
    const std::string place = fmt::format("{} | {}", scene.described, transforms[i].name);
    try {
      const Analysis found = test::analyse_as_read(transforms[i].change(scene));
      const test::Differences differences = test::differences(plain, found, transforms[i]);
      if (!differences.any()) continue;
      ++(differences.in_motion ? tally.motions : differences.in_numbers.empty() ? tally.known : tally.numbers);
      checked.report += fmt::format("{} | {}\n", place, differences.text());
      if (differences.in_motion) {
        checked.report += fmt::format("    {}\n    {}\n", plain.motion_reason, found.motion_reason);
      }
    } catch (const std::exception& refusal) {
      ++tally.refused;
      checked.report += fmt::format("{} | refused: {}\n", place, refusal.what());
    }
  }
  return checked;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t random = 24;
  std::vector<Scene> scenes;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--random" && i + 1 < argc) {
      random = std::stoull(argv[++i]);
      continue;
    }
    std::vector<Scene> more = scenes_of(argv[i]);
    scenes.insert(scenes.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  std::vector<Scene> simulated = simulated_scenes(random);
  scenes.insert(scenes.end(), std::make_move_iterator(simulated.begin()), std::make_move_iterator(simulated.end()));
  const std::vector<Checked> all = in_parallel(scenes.size(), [&](std::size_t i) { return check(scenes[i], i); });

  const std::vector<test::Transform> transforms = test::invariances(0);
  std::vector<Tally> tallies(transforms.size());
  for (const Checked& checked : all) {
    std::fputs(checked.report.c_str(), stdout);
    for (std::size_t i = 0; i < transforms.size(); ++i) tallies[i].add(checked.tallies[i]);
  }
  fmt::print("\n| transform | answers | kind of motion differs | a number differs | known in one only | refused |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  Tally total;
  const auto print = [](const std::string& name, const Tally& tally) {
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", name, tally.answers, tally.motions, tally.numbers, tally.known,
               tally.refused);
  };
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    print(transforms[i].name + (transforms[i].is_certain ? "" : " (not in the sum)"), tallies[i]);
    if (transforms[i].is_certain) total.add(tallies[i]);
  }
  print("all", total);
  return total.motions > 0 || 200 * total.different() > total.answers ? 1 : 0;
}
