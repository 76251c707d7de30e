#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "batch/result_log.hpp"
#include "batch/work_list.hpp"
#include "io/kept_recordings.hpp"
#include "slipfit/batch/options.hpp"
#include "slipfit/core/result.hpp"

// What happens in a process that fits, and its reply to the process that started it.

namespace slipfit::batch {

/// Returns the files that are read for these recordings, each once, in the order in which their document lists them.
std::vector<std::filesystem::path> input_files_of(std::span<const ManifestEntry> entries);

/// A recording or a group, and how it is fitted.
struct WorkItem {
  SlotKey key;
  std::size_t recordings = 1;
  std::vector<std::filesystem::path> inputs;
  std::function<Result<BatchFit>()> fit;
};

std::string name_of(const WorkItem& item);

/// Fits a recording. `kept` is the file of the previous row, of which this one may be another table.
Result<BatchFit> fit_recording_of(const ManifestEntry& entry, const BatchOptions& options, reading::KeptFile& kept);

struct Reply {
  enum class Kind : char {
    Fitted = 'R',
    FittedAnew = 'N',  ///< the recording was replaced since its last fit
    Kept = 'K',
    KeptUnread = 'U',  ///< the recording is gone
    Failed = 'F',
    Stop = 'S'  ///< the batch cannot continue
  };
  Kind kind = Kind::Kept;
  std::string document;
  Error error;
};

/// Fits the item unless its result exists and is of the same bytes, and writes its page. The reply as text.
std::string work_on(const WorkItem& item, const BatchOptions& options, const ResultLog& log);

Reply read_reply(const std::string& text);

}  // namespace slipfit::batch
