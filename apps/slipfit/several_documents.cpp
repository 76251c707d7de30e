#include "several_documents.hpp"

#include <fmt/format.h>

void SeveralDocuments::add(const std::string& document) {
  if (written_++ > 0) content_ += is_json_ ? ",\n" : "\n";
  content_ += is_json_ && recordings_ > 1 ? document.substr(0, document.find_last_not_of('\n') + 1) : document;
}

void SeveralDocuments::add_failure(ExitCode exit, const slipfit::Error& error) {
  if (recordings_ == 1) throw Failure(exit, error);
  ++failed_;
  say(error.message);
}

void SeveralDocuments::write(const DocumentOptions& options) const {
  if (written_ == 0) throw Failure(ExitCode::BadRecording, fmt::format("none of {} recordings can be read", failed_));
  const std::string content = is_json_ && recordings_ > 1 ? "[" + content_ + "]\n" : content_;
  write_results(options, [&content](const std::string&) { return content; });
  if (failed_ == 0) return;
  throw Failure(ExitCode::RecordingsFailed, fmt::format("{} of {} recordings failed", failed_, recordings_));
}
