#pragma once

#include <cstddef>
#include <string>

#include "failure.hpp"
#include "output.hpp"

/// The documents of a command that takes one recording or several. One document stays as it is; several are texts one
/// below the other, or one JSON array.
class SeveralDocuments {
 public:
  SeveralDocuments(std::size_t recordings, bool is_json) : recordings_(recordings), is_json_(is_json) {}

  /// A document with its line end.
  void add(const std::string& document);
  /// Adds the reason why a recording could not be read: thrown if it is the only one, otherwise printed at once.
  void add_failure(ExitCode exit, const slipfit::Error& error);
  /// Writes the documents. Throws Failure(RecordingsFailed) behind them where recordings failed, Failure(BadRecording)
  /// where all did.
  void write(const DocumentOptions& options) const;

 private:
  std::size_t recordings_ = 0;
  bool is_json_ = false;
  std::size_t failed_ = 0;
  std::size_t written_ = 0;
  std::string content_;
};
