#include "slipfit/batch/batch.hpp"
#include "slipfit/report/sweep.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

GroupFit group_fit(const FitOptions& options) {
  return [options](const std::string& id, const std::vector<ManifestEntry>& members) -> Result<std::string> {
    const auto entries = read_sweep(members);
    if (!entries) return entries.error();
    JsonOptions layout;
    layout.id = id;
    layout.layout = JsonLayout::OneLine;
    return to_json(entries.value(), analyze_sweep(entries.value(), options), layout);
  };
}

}  // namespace slipfit
