#pragma once

// Everything that a user of the library needs: read a recording, analyse or fit it, report the result.

#include "slipfit/core/units.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"
