#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "io/container/formats.hpp"
#include "io/container/table_text.hpp"
#include "io/container/tdms_segments.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

/// "Group" and "Channel" of "/'Group'/'Channel'"; a quote in a name is doubled. Empty where there is no such part.
std::pair<std::string, std::string> names_in(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] != '\'') continue;
    parts.emplace_back();
    for (++i; i < path.size() && (path[i] != '\'' || path.substr(i + 1, 1) == "'"); ++i) {
      if (path[i] == '\'') ++i;
      parts.back() += path[i];
    }
  }
  parts.resize(2);
  return {parts[0], parts[1]};
}

/// The channels of one group, behind a clock that its first channel states; a channel of time stamps becomes seconds
/// from its first.
NumberTable table_of(const std::vector<TdmsChannel>& channels, const std::string& group) {
  NumberTable table;
  for (const TdmsChannel& channel : channels) {
    const auto [of_group, name] = names_in(channel.path);
    if (of_group != group || channel.values.empty()) continue;
    if (table.columns.empty() && channel.increment_s && channel.type != kTdmsTimeStamp) {
      table.names.emplace_back("Time [s]");
      table.columns.emplace_back();
      for (std::size_t i = 0; i < channel.values.size(); ++i) {
        table.columns.back().push_back(channel.offset_s + static_cast<double>(i) * *channel.increment_s);
      }
    }
    const std::string unit = channel.type == kTdmsTimeStamp ? "s" : channel.unit;
    table.names.push_back(unit.empty() ? name : fmt::format("{} [{}]", name, unit));
    table.columns.push_back(channel.values);
    if (channel.type != kTdmsTimeStamp) continue;
    for (double& value : table.columns.back()) value -= channel.values.front();
  }
  return table;
}

/// The number of values in each group that has any.
std::map<std::string, std::size_t> values_by_group(const std::vector<TdmsChannel>& channels, const std::string& name) {
  std::map<std::string, std::size_t> values;
  for (const TdmsChannel& channel : channels) {
    if (!channel.values.empty()) values[names_in(channel.path).first] += channel.values.size();
  }
  if (values.empty()) throw damaged(name, "the TDMS file contains no channel of numbers");
  return values;
}

std::vector<std::string> names_of(const std::map<std::string, std::size_t>& values) {
  std::vector<std::string> groups;
  groups.reserve(values.size());
  for (const auto& [group, count] : values) groups.push_back(group);
  return groups;
}

/// The group with the most values, or the one that was asked for.
std::string choose_group(const std::map<std::string, std::size_t>& values, const std::string& name,
                         const ContainerChoice& choice) {
  if (choice.variable) {
    if (values.contains(*choice.variable)) return *choice.variable;
    throw ThrownError(
        {"unknown_variable",
         fmt::format("{}: the TDMS file contains no group '{}' with numbers, only '{}'; choose one with --variable",
                     name, printable(*choice.variable),
                     printable(fmt::format("{}", fmt::join(names_of(values), "', '"))))});
  }
  return std::ranges::max_element(values, [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

/// Errors: damaged_container, container_too_large, daqmx_channels.
TdmsContent read_file(TextStream packed, const std::string& name) {
  auto tdms = read_tdms(read_all(packed, name));
  if (!tdms) throw damaged(name, "the TDMS file is cut off or damaged");
  for (const TdmsChannel& channel : tdms->channels) {
    if (!channel.is_daqmx && !channel.is_scaled) continue;
    throw ThrownError(
        {"daqmx_channels",
         fmt::format("{}: channel '{}' contains raw DAQmx data, whose scale is not read; export scaled values or CSV",
                     name, printable(names_in(channel.path).second))});
  }
  return *std::move(tdms);
}

TextStream text_of_group(const TdmsContent& tdms, const std::string& group) {
  TextStream text;
  text.bytes = text_of(table_of(tdms.channels, group));
  text.assumed.push_back(fmt::format("Group '{}' of the TDMS file was read.", printable(group)));
  if (tdms.bytes_left_over > 0) {
    text.warnings.push_back(
        {"container_cut", fmt::format("the last block of the TDMS file is cut off: its {} bytes were left out; if "
                                      "samples are missing, copy the file again",
                                      tdms.bytes_left_over)});
  }
  return text;
}

}  // namespace

TextStream open_tdms(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  const TdmsContent tdms = read_file(std::move(packed), name);
  const auto values = values_by_group(tdms.channels, name);
  TextStream text = text_of_group(tdms, choose_group(values, name, choice));
  text.tables = names_of(values);
  return text;
}

void visit_tdms(TextStream packed, const std::string& name, const TableVisitor& visit) {
  const TdmsContent tdms = read_file(std::move(packed), name);
  for (const std::string& group : names_of(values_by_group(tdms.channels, name))) {
    visit({group, [&] { return text_of_group(tdms, group); }});
  }
}

}  // namespace slipfit::reading
