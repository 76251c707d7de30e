// TDMS, National Instruments' binary files, by "The NI TDMS File Format" (ni.com, white paper 5696): segments of a
// lead-in, meta data and raw data. Channels of plain numbers and time stamps are read; DAQmx raw data and strings are
// not.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/container/cursor.hpp"
#include "io/container/formats.hpp"
#include "io/container/table_text.hpp"
#include "io/message.hpp"

namespace slipfit::reading {

namespace {

enum Toc : std::uint32_t {
  kMeta = 1U << 1U,
  kNewObjects = 1U << 2U,
  kRaw = 1U << 3U,
  kInterleaved = 1U << 5U,
  kBigEndian = 1U << 6U,
  kDaqmx = 1U << 7U
};

constexpr std::uint32_t kString = 0x20;
constexpr std::uint32_t kNoData = 0xFFFFFFFF;
constexpr std::uint32_t kFormatChanging = 0x00001269;
constexpr std::uint32_t kDigitalLine = 0x0000126A;

constexpr std::uint32_t kTdmsTimeStamp = 0x44;

/// A channel with its values, and the position of the reader in it.
struct TdmsChannel {
  std::string path;
  std::string unit;
  std::optional<double> increment_s;
  double offset_s = 0.0;
  bool is_scaled = false;  ///< its integers mean something else
  bool is_daqmx = false;
  bool has_data = false;  ///< in this segment
  std::uint32_t type = 0;
  std::uint64_t count = 0;  ///< values in a block
  std::uint64_t bytes = 0;  ///< of a block
  std::vector<double> values;
};

struct TdmsContent {
  std::vector<TdmsChannel> channels;  ///< in the order in which they appear
  std::uint64_t bytes_left_over = 0;  ///< of a block that is not whole, which a writer that was stopped leaves
};

double read_time_stamp(Cursor& cursor) {
  const double fraction = std::ldexp(read_number<std::uint64_t>(cursor), -64);
  return read_number<std::int64_t>(cursor) + fraction;
}

constexpr std::array kNumberTypes{
    number_type<std::int8_t>(1U),     number_type<std::int16_t>(2U),
    number_type<std::int32_t>(3U),    number_type<std::int64_t>(4U),
    number_type<std::uint8_t>(5U),    number_type<std::uint16_t>(6U),
    number_type<std::uint32_t>(7U),   number_type<std::uint64_t>(8U),
    number_type<float>(9U),           number_type<double>(10U),
    number_type<float>(0x19U),        number_type<double>(0x1AU),
    number_type<std::uint8_t>(0x21U), NumberType<std::uint32_t>{kTdmsTimeStamp, 16, read_time_stamp}};

void append_value(TdmsChannel& channel, Cursor& cursor) {
  const auto* const type = find_type(kNumberTypes, channel.type);
  if (type == nullptr) throw Damaged{};
  channel.values.push_back(type->read(cursor));
}

class TdmsReader {
 public:
  explicit TdmsReader(std::string_view file) : file_(file) {}

  /// Throws Damaged.
  TdmsContent read() {
    constexpr std::size_t kLeadIn = 28;
    std::size_t begin = 0;
    while (begin + kLeadIn <= file_.size()) {
      const std::string_view lead = file_.substr(begin, kLeadIn);
      if (!lead.starts_with("TDSm")) throw Damaged{};
      const auto toc = Cursor(lead.substr(4), std::endian::little).number<std::uint32_t>();
      const auto order = (toc & kBigEndian) != 0 ? std::endian::big : std::endian::little;
      Cursor sizes(lead.substr(12), order);
      const std::uint64_t left = file_.size() - begin - kLeadIn;
      const std::uint64_t segment = std::min(sizes.number<std::uint64_t>(), left);  // all ones: the writer did not end
      const auto meta = sizes.number<std::uint64_t>();
      if (meta > segment) throw Damaged{};
      const std::string_view body = file_.substr(begin + kLeadIn, static_cast<std::size_t>(segment));
      Cursor cursor(body.substr(0, static_cast<std::size_t>(meta)), order);
      if ((toc & kMeta) != 0) read_meta(cursor, toc);
      if ((toc & kRaw) != 0) read_raw(body.substr(static_cast<std::size_t>(meta)), order, toc);
      begin += kLeadIn + static_cast<std::size_t>(segment);
    }
    left_over_ += file_.size() - begin;
    return {std::move(channels_), left_over_};
  }

 private:
  TdmsChannel& channel_of(const std::string& path) {
    constexpr std::size_t kMostObjects = 4096;
    const auto [place, is_new] = index_.emplace(path, channels_.size());
    if (index_.size() > kMostObjects) throw Damaged{};
    if (is_new) channels_.push_back({path, {}, {}, 0.0, false, false, false, 0, 0, 0, {}});
    return channels_[place->second];
  }

  void read_meta(Cursor& cursor, std::uint32_t toc) {
    if ((toc & kNewObjects) != 0) {
      order_.clear();
      for (TdmsChannel& channel : channels_) channel.has_data = false;
    }
    const auto objects = cursor.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < objects; ++i) {
      TdmsChannel& channel = channel_of(cursor.text());
      read_index(cursor, channel);
      const std::size_t at = index_.at(channel.path);
      std::erase(order_, at);
      if (channel.has_data) order_.push_back(at);
      const auto properties = cursor.number<std::uint32_t>();
      for (std::uint32_t p = 0; p < properties; ++p) read_property(cursor, channel);
    }
  }

  static void read_index(Cursor& cursor, TdmsChannel& channel) {
    const auto length = cursor.number<std::uint32_t>();
    channel.has_data = length != kNoData;
    if (!channel.has_data || length == 0) return;  // 0: as in the segment before
    channel.is_daqmx = length == kFormatChanging || length == kDigitalLine;
    channel.type = cursor.number<std::uint32_t>();
    if (cursor.number<std::uint32_t>() != 1) throw Damaged{};  // one dimension
    channel.count = cursor.number<std::uint64_t>();
    if (channel.is_daqmx) {
      const auto skip_vector = [&](std::uint32_t entry) {
        (void)cursor.bytes(std::uint64_t{entry} * cursor.number<std::uint32_t>());
      };
      skip_vector(channel.type == kNoData ? 20 : 17);
      skip_vector(4);
      return;
    }
    const auto* const type = find_type(kNumberTypes, channel.type);
    if (type == nullptr && channel.type != kString) throw Damaged{};
    if (type != nullptr && channel.count > UINT64_MAX / type->bytes) throw Damaged{};
    channel.bytes = type == nullptr ? cursor.number<std::uint64_t>() : channel.count * type->bytes;
  }

  static void read_property(Cursor& cursor, TdmsChannel& channel) {
    const std::string name = cursor.text();
    const auto type = cursor.number<std::uint32_t>();
    if (type == kString) {
      const std::string value = cursor.text();
      if (name == "unit_string") channel.unit = value;
      return;
    }
    const auto* const number = find_type(kNumberTypes, type);
    if (number == nullptr) throw Damaged{};
    const double value = number->read(cursor);
    if (name == "wf_increment" && value > 0.0) channel.increment_s = value;
    if (name == "wf_start_offset") channel.offset_s = value;
    if (name == "NI_Number_Of_Scales") channel.is_scaled = value > 0.0;
  }

  void read_raw(std::string_view raw, std::endian order, std::uint32_t toc) {
    std::uint64_t block = 0;
    for (const std::size_t at : order_) {
      TdmsChannel& channel = channels_[at];
      channel.is_daqmx = channel.is_daqmx || (toc & kDaqmx) != 0;
      if (channel.is_daqmx) return;
      if (channel.bytes > raw.size()) throw Damaged{};
      block += channel.bytes;
    }
    if (block == 0) return;
    left_over_ += raw.size() % block;
    Cursor cursor(raw, order);
    for (std::uint64_t blocks = raw.size() / block; blocks > 0; --blocks) {
      (toc & kInterleaved) != 0 ? read_interleaved(cursor) : read_in_turn(cursor);
    }
  }

  void read_in_turn(Cursor& cursor) {
    for (const std::size_t at : order_) {
      TdmsChannel& channel = channels_[at];
      if (channel.type == kString) {
        (void)cursor.bytes(channel.bytes);
        continue;
      }
      for (std::uint64_t i = 0; i < channel.count; ++i) append_value(channel, cursor);
    }
  }

  void read_interleaved(Cursor& cursor) {
    const std::uint64_t count = channels_[order_.front()].count;
    for (const std::size_t at : order_) {
      if (channels_[at].count != count || channels_[at].type == kString) throw Damaged{};
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      for (const std::size_t at : order_) append_value(channels_[at], cursor);
    }
  }

  std::string_view file_;
  std::vector<TdmsChannel> channels_;
  std::map<std::string, std::size_t> index_;
  std::vector<std::size_t> order_;  ///< channels with data in this segment
  std::uint64_t left_over_ = 0;
};

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

/// The channels of one group, after a clock that its first channel states; a channel of time stamps becomes seconds
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
                         const std::optional<std::string>& wanted) {
  if (wanted) {
    if (values.contains(*wanted)) return *wanted;
    throw ThrownError(
        {"unknown_variable",
         fmt::format("{}: the TDMS file contains no group '{}' with numbers, only '{}'; choose one with --variable",
                     name, printable_utf8(*wanted),
                     printable_utf8(fmt::format("{}", fmt::join(names_of(values), "', '"))))});
  }
  return std::ranges::max_element(values, [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

/// Errors: damaged_container, container_too_large, daqmx_channels.
TdmsContent read_file(TextStream packed, const std::string& name) {
  TdmsContent tdms;
  try {
    const std::string file = read_all(packed, name);
    tdms = TdmsReader(file).read();
  } catch (const Damaged&) {
    throw damaged(name, "the TDMS file is cut off or damaged");
  }
  for (const TdmsChannel& channel : tdms.channels) {
    if (!channel.is_daqmx && !channel.is_scaled) continue;
    throw ThrownError(
        {"daqmx_channels",
         fmt::format("{}: channel '{}' contains raw DAQmx data, whose scale is not read; export scaled values or CSV",
                     name, printable_utf8(names_in(channel.path).second))});
  }
  return tdms;
}

TextStream text_of_group(const TdmsContent& tdms, const std::string& group) {
  TextStream text;
  text.bytes = text_of(table_of(tdms.channels, group));
  text.assumed.push_back(fmt::format("Group '{}' of the TDMS file was read.", printable_utf8(group)));
  if (tdms.bytes_left_over > 0) {
    text.warnings.push_back(
        {"container_cut", fmt::format("the last block of the TDMS file is cut off: its {} bytes were left out; if "
                                      "samples are missing, copy the file again",
                                      tdms.bytes_left_over)});
  }
  return text;
}

}  // namespace

Container open_tdms(TextStream packed, const std::string& name) {
  const auto tdms = std::make_shared<const TdmsContent>(read_file(std::move(packed), name));
  const auto values = values_by_group(tdms->channels, name);
  return {
      [=](const std::optional<std::string>& group) { return text_of_group(*tdms, choose_group(values, name, group)); },
      [=] { return names_of(values); }};
}

}  // namespace slipfit::reading
