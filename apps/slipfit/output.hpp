#pragma once

#include <string>
#include <vector>

/// A file that an option names, and the option for messages.
struct OutputFile {
  std::string option;
  std::string file;
};

/// Before any work: throws Failure(WrongUsage) where an output is the input, is named twice, is a folder, or has no
/// folder.
void check_outputs(const std::vector<OutputFile>& outputs, const std::string& input);

/// Made where it is missing, but not what it stands in: a slip of the pen makes no tree. Throws Failure(WrongUsage).
void make_folder(const OutputFile& folder);

/// Through a temporary file beside it and a rename: readers see the old content or the new, never a part.
/// What is no regular file (a pipe, /dev/stdout) is written directly.
void write_file(const OutputFile& output, const std::string& content);

void write_standard_output(const std::string& content);

/// A message to standard error, "slipfit: ...", on one line.
void say(const std::string& message);

/// A command as a shell takes it: `slipfit` and the words behind the first, quoted where they must be.
std::string shell_line(const std::vector<std::string>& words);
