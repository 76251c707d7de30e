#pragma once

#include <cstdio>
#include <memory>
#include <string>

struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Returns the contents of a file that slipfit fit --json wrote. Throws Failure(WrongUsage) if it cannot be read.
std::string document_text(const std::string& file);
