#include "document_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include "failure.hpp"
#include "slipfit/report/fit_document.hpp"

std::string document_text(const std::string& file) {
  const auto refuse_reading = [&file] {
    refuse("'{}': cannot read: {}; expected the document that slipfit fit --json --out FIT.json writes", file,
           std::strerror(errno));
  };
  const File stream(std::fopen(file.c_str(), "rb"));
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
