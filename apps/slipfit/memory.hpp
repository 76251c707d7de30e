#pragma once

#include <string>

/// Settings of the allocator for the analysis of one file, where it is glibc's: freed memory is used again and not
/// returned to the system, and it comes in large pages where the system offers them. Each new page costs a fault, half
/// a microsecond to ten (virtual machines): of 200 000 rows 4 000 faults become 600, a quarter of the time of `slipfit
/// fit` on a virtual machine. Nothing happens for a file of more than 1 GB, which may not fit into the memory, nor for
/// what has no size.
void prepare_memory(const std::string& file);
