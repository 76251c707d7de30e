#include "slipfit/io/recording_reader.hpp"

#include <fmt/format.h>

#include <system_error>
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

std::vector<NamedRecording> build_segments(const Rows& rows, const OpenedFile& file, const Conditions& conditions) {
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

std::vector<NamedRecording> take_apart(OpenedFile file, const Conditions& conditions) {
  const ReadOptions& options = file.options;
  if (options.pieces == Pieces::Segments && !options.step) return build_segments(file.rows, file, conditions);
  Part part = take_part(file);
  if (options.pieces == Pieces::Segments) return build_segments(part.rows, file, conditions);
  if (options.pieces != Pieces::One) return build_strokes(std::move(part), file, conditions);
  std::vector<NamedRecording> one;
  one.push_back({{}, build_recording(std::move(part), file, conditions)});
  return one;
}

std::vector<NamedRecording> pieces_in(const Container& container, const std::string& name, const Conditions& conditions,
                                      const ReadOptions& options) {
  OpenedFile file = open_file(container, name, options);
  file.choice = choose_columns(file.layout, options, conditions.speed_m_per_s, name);
  load_rows(file);
  return take_apart(std::move(file), conditions);
}

}  // namespace

namespace reading {

Container KeptFile::open(const std::filesystem::path& file, const std::string& name, const ReadOptions& options) {
  constexpr std::uintmax_t kMostKept = std::uintmax_t{1} << 30U;  // larger files are read for each table
  std::error_code no_size;
  std::error_code no_time;
  const std::uintmax_t size = std::filesystem::file_size(file, no_size);
  const auto changed = std::filesystem::last_write_time(file, no_time);
  const bool can_be_kept = !no_size && !no_time && size <= kMostKept;
  if (can_be_kept && file_ && path_ == file && size_ == size && changed_ == changed) return *file_;
  file_.reset();
  Container opened = open_container(open_plain(file), name, options);
  if (!can_be_kept || opened.choice == nullptr) return opened;
  path_ = file;
  size_ = size;
  changed_ = changed;
  return file_.emplace(std::move(opened));
}

Result<std::vector<NamedRecording>> read_pieces(KeptFile& kept, const std::filesystem::path& file,
                                                const Conditions& conditions, const ReadOptions& options) {
  const std::string name = name_of_file(file);
  return with_errors_of_reading(name, [&] {
    check_options(options, name);
    return pieces_in(kept.open(file, name, options), name, conditions, options);
  });
}

Result<Recording> read_recording(KeptFile& kept, const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  ReadOptions in_one_piece = options;
  in_one_piece.pieces = Pieces::One;
  auto pieces = read_pieces(kept, file, conditions, in_one_piece);
  if (!pieces) return pieces.error();
  return std::move(std::move(pieces).value().front().recording);
}

}  // namespace reading

Result<Recording> read_recording(const std::filesystem::path& file, const Conditions& conditions,
                                 const ReadOptions& options) {
  KeptFile only;
  return reading::read_recording(only, file, conditions, options);
}

Result<std::vector<NamedRecording>> read_pieces(const std::filesystem::path& file, const Conditions& conditions,
                                                const ReadOptions& options) {
  KeptFile only;
  return reading::read_pieces(only, file, conditions, options);
}

Result<std::vector<NamedRecording>> read_samples(Samples samples, const Conditions& conditions,
                                                 const ReadOptions& options) {
  const std::string name = samples.name;
  return with_errors_of_reading(name,
                                [&] { return take_apart(load_samples(std::move(samples), options), conditions); });
}

}  // namespace slipfit
