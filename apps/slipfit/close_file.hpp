#pragma once

#include <cstdio>

/// Deleter of a std::unique_ptr<std::FILE>.
struct CloseFile {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};
