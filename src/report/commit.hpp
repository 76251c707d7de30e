#pragma once

#include <string>

namespace slipfit {

/// Returns the commit of the sources of this build; empty if they were not checked out by git.
std::string commit_of_program();

}  // namespace slipfit
