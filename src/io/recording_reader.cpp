#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/build.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "io/part.hpp"

namespace slipfit {
namespace {

using namespace reading;

Result<std::vector<NamedRecording>> build_segments(const Rows& rows, const LoadedFile& file,
                                                   const Conditions& conditions) {
  std::vector<NamedRecording> recordings;
  for (Part& part : take_segments(rows)) {
    auto recording = build_recording(std::move(part), file, conditions);
    if (!recording) return recording.error();
    recordings.push_back({fmt::format("segment {}", recordings.size() + 1), std::move(recording).value()});
    if (recordings.size() == kMostPieces) break;
  }
  if (recordings.size() > 1) return recordings;
  return Error{"no_segments", file.name +
                                  ": there are no several stretches of one speed each, neither by a column of "
                                  "speeds nor by steps; leave out --segments"};
}

Result<std::vector<NamedRecording>> take_apart(LoadedFile file, const Conditions& conditions) {
  const ReadOptions& options = file.options;
  if (options.pieces == Pieces::Segments && !options.step) return build_segments(file.rows, file, conditions);
  auto part = take_part(std::move(file.rows), options, file.name);
  if (!part) return part.error();
  if (options.pieces == Pieces::Segments) return build_segments(part.value().rows, file, conditions);
  if (options.pieces != Pieces::One) return build_strokes(std::move(part).value(), file, conditions);
  auto recording = build_recording(std::move(part).value(), file, conditions);
  if (!recording) return recording.error();
  std::vector<NamedRecording> one;
  one.push_back({{}, std::move(recording).value()});
  return one;
}

}  // namespace

Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  ReadOptions one = options;
  one.pieces = Pieces::One;
  auto pieces = read_pieces(file, conditions, one);
  if (!pieces) return pieces.error();
  return std::move(std::move(pieces).value().front().recording);
}

Result<std::vector<NamedRecording>> read_pieces(const std::filesystem::path& file, const Conditions& conditions,
                                                const ReadOptions& options) {
  return with_errors_of_reading(name_of_file(file), [&]() -> Result<std::vector<NamedRecording>> {
    auto loaded = load_file(file, conditions.speed_m_per_s, options);
    if (!loaded) return loaded.error();
    return take_apart(std::move(loaded).value(), conditions);
  });
}

Result<std::vector<NamedRecording>> read_samples(Samples samples, const Conditions& conditions,
                                                 const ReadOptions& options) {
  const std::string name = samples.name;
  return with_errors_of_reading(name, [&]() -> Result<std::vector<NamedRecording>> {
    auto loaded = load_samples(std::move(samples), options);
    if (!loaded) return loaded.error();
    return take_apart(std::move(loaded).value(), conditions);
  });
}

}  // namespace slipfit
