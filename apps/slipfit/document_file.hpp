#pragma once

#include <string>

/// Returns the contents of a file that slipfit fit --json wrote. Throws Failure(WrongUsage) if it cannot be read.
std::string document_text(const std::string& file);

/// Returns the contents of a file, or an empty text if it cannot be read.
std::string text_of_file(const std::string& file);
