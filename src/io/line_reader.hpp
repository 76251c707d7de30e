#pragma once

// Its reading thread, for files above 32 MB, saves little and would be one more that cannot start where threads are
// scarce.
#define CSV_IO_NO_THREAD

// fast-cpp-csv-parser, of which only the line reader is used. It cuts long file names with strncpy on purpose, which
// g++ warns of where it inlines it into our code.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#endif
#include <csv.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
