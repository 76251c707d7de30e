#pragma once

#include <string>

namespace slipfit::batch {

/// The build of this code: compiler, its options, and a digest of the sources. Other builds may give other digits.
std::string build_of_program();

/// Architecture of the processor, and those of its instruction sets by which the mathematical libraries choose their
/// code ("x86_64 fma avx2"). With others the last digits of results may differ.
std::string processor_of_machine();

}  // namespace slipfit::batch
