#include "slipfit/background.hpp"
#include "slipfit/batch/batch.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/report/sweep_html.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

GroupFit group_fit(const FitOptions& options, const std::optional<BatchReport>& report) {
  return [options, report](const std::string& id, const std::vector<ManifestEntry>& members) -> Result<BatchFit> {
    const auto entries = read_sweep(members);
    if (!entries) return entries.error();
    JsonOptions layout;
    layout.id = id;
    layout.layout = JsonLayout::OneLine;
    const SweepAnalysis sweep = analyze_sweep(entries.value(), options);
    BatchFit fit{to_json(entries.value(), sweep, layout), {}, {}};
    if (report) {
      fit.page = to_html(entries.value(), sweep, predict_around(entries.value(), sweep),
                         SweepOrigin{id, report->command_line + "  # " + id});
    }
    return fit;
  };
}

}  // namespace slipfit
