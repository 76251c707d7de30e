#include <fmt/format.h>

#include <utility>

#include "core/thrown_error.hpp"
#include "io/opened_file.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {
namespace {

void check_samples(const Samples& samples, const ReadOptions& options) {
  check_options(options, samples.name);
  if (samples.time.empty() && !options.sample_rate_Hz) {
    throw ThrownError(
        {"no_time_column",
         fmt::format("{}: the times are missing; give one for each sample, or --sample-rate", samples.name)});
  }
  if (samples.time.empty() || samples.time.size() == samples.force.size()) return;
  throw ThrownError({"length_mismatch", fmt::format("{}: {} times and {} forces, expected equal numbers", samples.name,
                                                    samples.time.size(), samples.force.size())});
}

Channel time_channel(const ReadOptions& options) {
  Channel channel;
  channel.scale = value_or_throw(parse_unit(options.time_unit.value_or("s"), Dimension::Time)).scale;
  return channel;
}

Channel force_channel(const ReadOptions& options, const std::string& name) {
  const std::string text = options.force_unit.value_or("N");
  const auto unit = parse_unit(text, Dimension::Force);
  const auto share = parse_unit(text, Dimension::Dimensionless);
  const auto torque = parse_unit(text, Dimension::Torque);
  if (!unit && !share && !torque) throw ThrownError(unit.error());
  Channel channel;
  channel.column = 1;
  if (torque) {
    channel.scale = torque.value().scale / radius_for_torque(options.radius_m, name + ": the force");
    return channel;
  }
  channel.scale = unit ? unit.value().scale : share.value().scale;
  channel.quantity = unit ? ForceQuantity::Force_N : ForceQuantity::FrictionCoefficient;
  return channel;
}

/// The clock of samples without times.
std::vector<double> even_clock(std::size_t count, double sample_rate_Hz) {
  std::vector<double> time_s(count);
  for (std::size_t i = 0; i < count; ++i) time_s[i] = static_cast<double>(i) / sample_rate_Hz;
  return time_s;
}

void scale_by(std::vector<double>& values, double scale) {
  if (scale == 1.0) return;
  for (double& value : values) value *= scale;
}

}  // namespace

LoadedFile load_samples(Samples samples, const ReadOptions& options) {
  check_samples(samples, options);
  const Channel time = time_channel(options);
  LoadedFile file;
  file.name = samples.name;
  file.options = options;
  file.layout.columns.resize(2);
  file.layout.columns[0].name.text = "time";
  file.layout.columns[1].name.text = "force";
  if (!samples.time.empty()) file.choice.time = time;
  file.choice.force = force_channel(options, samples.name);
  Rows& rows = file.rows;
  rows.force = std::move(samples.force);
  rows.count = rows.force.size();
  rows.time_s = samples.time.empty() ? even_clock(rows.count, *options.sample_rate_Hz) : std::move(samples.time);
  if (file.choice.time) scale_by(rows.time_s, time.scale);
  scale_by(rows.force, file.choice.force.scale);
  rows.keep_wanted(options.rows, options.window);
  return file;
}

}  // namespace slipfit::reading
