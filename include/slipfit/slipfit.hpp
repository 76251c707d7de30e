#pragma once

// Everything that a user of the library needs: read a recording, analyse or fit it, report the result.

#include "slipfit/batch/batch.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/paper.hpp"
#include "slipfit/model/sensitivity.hpp"
#include "slipfit/model/simulation.hpp"
#include "slipfit/model/velocity.hpp"
#include "slipfit/model/waveform.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/predict/plan.hpp"
#include "slipfit/predict/prediction.hpp"
#include "slipfit/report/csv.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/plan.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/text.hpp"
