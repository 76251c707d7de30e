#include "document_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "close_file.hpp"
#include "failure.hpp"
#include "slipfit/report/fit_document.hpp"

std::string text_of_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string document_text(const std::string& file) {
  const auto refuse = [&file](const std::string& message) {
    throw Failure(ExitCode::WrongUsage, fmt::format("'{}': {}", file, message));
  };
  const auto refuse_reading = [&refuse] {
    refuse(fmt::format("cannot read: {}; expected the document that slipfit fit --json --out FIT.json writes",
                       std::strerror(errno)));
  };
  const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
  if (!stream) refuse_reading();
  std::string content;
  std::array<char, 65536> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), stream.get())) {
    content.append(part.data(), count);
    if (content.size() > slipfit::kLargestFitDocument) break;  // refused where documents are checked
  }
  if (std::ferror(stream.get()) != 0) refuse_reading();
  return content;
}
