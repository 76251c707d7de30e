#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>
#include <utility>

#include "core/thrown_error.hpp"
#include "io/build.hpp"
#include "io/kept_recordings.hpp"
#include "io/message.hpp"
#include "io/opened_file.hpp"
#include "io/part.hpp"

namespace slipfit {

namespace {

using namespace reading;

std::vector<NamedRecording> build_segments(const Rows& rows, const LoadedFile& file, const Conditions& conditions) {
  std::vector<NamedRecording> recordings;
  for (Part& part : take_segments(rows)) {
    recordings.push_back(
        {fmt::format("segment {}", recordings.size() + 1), build_recording(std::move(part), file, conditions)});
    if (recordings.size() == kMostPieces) break;
  }
  if (recordings.size() > 1) return recordings;
  throw ThrownError(
      {"no_segments",
       file.name +
           ": neither a column of speeds nor steps give several sections of constant speed; leave out --segments"});
}

std::vector<NamedRecording> take_apart(LoadedFile file, const Conditions& conditions) {
  const ReadOptions& options = file.options;
  if (options.pieces == Pieces::Segments && !options.step) return build_segments(file.rows, file, conditions);
  Part part = take_part(std::move(file.rows), options, file.name);
  if (options.pieces == Pieces::Segments) return build_segments(part.rows, file, conditions);
  if (options.pieces != Pieces::One) return build_strokes(std::move(part), file, conditions);
  std::vector<NamedRecording> one;
  one.push_back({{}, build_recording(std::move(part), file, conditions)});
  return one;
}

/// `open`: opens the file.
template <class Open>
Result<std::vector<NamedRecording>> pieces_of(const std::filesystem::path& file, const Conditions& conditions,
                                              const ReadOptions& options, const Open& open) {
  const std::string name = name_of_file(file);
  return with_errors_of_reading(name, [&] {
    check_options(options, name);
    return take_apart(load_file(open(file), name, conditions.speed_m_per_s, options), conditions);
  });
}

Result<Recording> only_one(Result<std::vector<NamedRecording>> pieces) {
  if (!pieces) return pieces.error();
  return std::move(std::move(pieces).value().front().recording);
}

ReadOptions in_one_piece(ReadOptions options) {
  options.pieces = Pieces::One;
  return options;
}

}  // namespace

namespace reading {

Result<std::vector<NamedRecording>> read_pieces(KeptFile& kept, const std::filesystem::path& file,
                                                const Conditions& conditions, const ReadOptions& options) {
  if (!options.sheet && !options.variable) return slipfit::read_pieces(file, conditions, options);
  return pieces_of(file, conditions, options, [&](const std::filesystem::path& path) { return kept.open(path); });
}

Result<Recording> read_recording(KeptFile& kept, const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  return only_one(read_pieces(kept, file, conditions, in_one_piece(options)));
}

}  // namespace reading

Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  return only_one(read_pieces(file, conditions, in_one_piece(options)));
}

Result<std::vector<NamedRecording>> read_pieces(const std::filesystem::path& file, const Conditions& conditions,
                                                const ReadOptions& options) {
  return pieces_of(file, conditions, options, open_plain);
}

Result<std::vector<NamedRecording>> read_samples(Samples samples, const Conditions& conditions,
                                                 const ReadOptions& options) {
  const std::string name = samples.name;
  return with_errors_of_reading(name,
                                [&] { return take_apart(load_samples(std::move(samples), options), conditions); });
}

}  // namespace slipfit
