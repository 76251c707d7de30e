#pragma once

#include <string>

namespace slipfit {

/// Of the sources of this build; empty where they were not checked out by git.
std::string commit_of_program();

}  // namespace slipfit
