#include "slipfit/report/fit_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/statistics.hpp"
#include "report/document/json_node.hpp"
#include "report/names.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/predict/single_speed.hpp"

namespace slipfit {
namespace {

using documents::JsonNode;
using documents::with_document;

/// Parameters without which there is no prediction: the first of ModelEstimate::covariance.
constexpr std::span kNeeded = std::span(kModelParameters).first<4>();

std::string key_of(ParameterId id) {
  return std::string(info(id).key);
}

/// Returns whether a prediction has a value of the parameter. Where the recordings leave the damping ratio open, the
/// correlation has the one with which the others were fitted.
bool predicts(ParameterId id, ParameterStatus status) {
  if (status == ParameterStatus::Bounded) return id == ParameterId::DampingRatio;
  return status != ParameterStatus::Unidentified;
}

/// Reads the model of a document that check_document accepted. Documents of earlier versions lack parts of it. Throws
/// ThrownError.
class ModelReader {
 public:
  ModelReader(const JsonNode& document, const std::string& name) : document_(document), name_(name) {}

  [[nodiscard]] PredictionModel model() const {
    if (!document_.has("parameters")) {
      throw ThrownError(
          Error{"cannot_predict", fmt::format("'{}': has no parameters: slipfit analyze fits none, and fit found no "
                                              "cycles; use slipfit fit on stick-slip",
                                              printable(name_))});
    }
    check_known();
    PredictionModel model;
    ModelEstimate& estimate = model.estimate;
    for (const ParameterId id : kNeeded) *estimate.find(id) = needed_value(id);
    add_terms(estimate);
    const JsonNode damping = parameter(ParameterId::DampingRatio);
    const std::optional<Interval> bounds = damping.estimate().ci95;
    estimate.damping_identified = status_of(damping) == ParameterStatus::Fixed || (bounds && bounds->low > 0.0);
    estimate.degrees_of_freedom = degrees_of_freedom();
    if (const auto correlation = document_.known("correlation")) read_covariance(*correlation, model);
    model.kinetic_friction_N = kinetic_friction_N();
    estimate.reach = reach();
    if (const auto speed = document_.known("recording", "speed_m_per_s")) {
      std::array<ParameterStatus, kNeeded.size()> statuses{};
      for (std::size_t i = 0; i < statuses.size(); ++i) statuses[i] = status_of(parameter(kNeeded[i]));
      estimate = from_single_speed(estimate, speed->positive(), statuses);
    }
    for (const char* const section : {"recording", "model"}) {  // the load that all recordings of a sweep state
      if (const auto load = document_.known(section, "normal_force_N")) estimate.normal_force_N = load->positive();
    }
    model.observed_end = observed_end();
    return model;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw ThrownError(
        Error{"cannot_predict", fmt::format("'{}': cannot predict: {}", printable(name_), printable(why))});
  }

  [[nodiscard]] JsonNode parameter(ParameterId id) const { return document_.member("parameters", key_of(id)); }
  static ParameterStatus status_of(const JsonNode& parameter) {
    return *with_name<ParameterStatus>(parameter.member("status").text());
  }

  /// Refuses a document in which a needed parameter is not known, with the note of the fit.
  void check_known() const {
    std::vector<std::string> open;
    std::string note;
    for (const ParameterId id : kNeeded) {
      const std::string key = key_of(id);
      if (!document_.member("parameters").has(key)) {
        open.push_back(key + " is absent");
        continue;
      }
      const ParameterStatus status = status_of(parameter(id));
      if (predicts(id, status)) continue;
      open.push_back(fmt::format("{} is {}", key, name_of(status)));
      if (note.empty()) note = parameter(id).text_at("note");
    }
    if (open.empty()) return;
    refuse(fmt::format("{}{}; a prediction needs all four of k, w_n, zeta and F_s - F_k", fmt::join(open, ", "),
                       note.empty() ? note : " (" + note + ")"));
  }

  [[nodiscard]] double needed_value(ParameterId id) const {
    const JsonNode value = parameter(id).member("value");
    if (id != ParameterId::DampingRatio) return value.positive();
    const auto is_damping = [](double zeta) { return zeta >= 0.0 && zeta < 1.0; };
    if (status_of(parameter(id)) != ParameterStatus::Bounded)
      return value.number_that(is_damping, "a number in [0, 1)");
    const double zeta = working_value(id);
    if (!is_damping(zeta)) refuse(key_of(id) + " is not in [0, 1)");
    return zeta;
  }

  /// Returns the place of a parameter in the correlation, or nothing if the model does not contain it.
  [[nodiscard]] std::optional<std::size_t> row_of(ParameterId id) const {
    const std::vector<JsonNode> names = document_.elements_of("correlation", "names");
    const auto found = std::ranges::find(names, key_of(id), &JsonNode::text);
    return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
  }
  [[nodiscard]] std::size_t needed_row_of(ParameterId id) const {
    const std::optional<std::size_t> row = row_of(id);
    if (!row) document_.member("correlation", "names").fail("a list with " + key_of(id));
    return *row;
  }

  /// Returns a value from the correlation, which also contains parameters that the data determine only together with
  /// others.
  [[nodiscard]] double working_value(ParameterId id) const {
    const std::optional<JsonNode> correlation = document_.known("correlation");
    if (!correlation) refuse(key_of(id) + " needs correlation (with its values), which is missing");
    const std::size_t count = correlation->member("names").elements().size();
    const std::vector<JsonNode> values = correlation->member("values").elements(count, "as many numbers as names");
    return values[needed_row_of(id)].number_that([](double) { return true; }, "a number");
  }
  [[nodiscard]] double positive_value(ParameterId id) const {
    const double value = working_value(id);
    if (!(value > 0.0)) refuse(key_of(id) + " is not above 0");
    return value;
  }

  /// Adds what the model contains besides the four parameters.
  void add_terms(ModelEstimate& estimate) const {
    using Id = ParameterId;
    if (const auto tier = document_.known("model", "tier"); tier && tier->text() == name_of(Tier::Velocity)) {
      estimate.speed_dependence = SpeedDependence{working_value(Id::FrictionSlope), working_value(Id::Alpha)};
    }
    if (const auto stick_s = document_.known("model", "ageing_reference_s")) {
      const double rate_N = working_value(Id::Ageing);  // below 0 where friction falls with the time of rest
      const double cutoff_s = row_of(Id::AgeingTime) ? working_value(Id::AgeingTime) : 0.0;
      if (!(cutoff_s >= 0.0)) refuse("ageing_time_s is below 0");
      estimate.ageing = Ageing{rate_N, stick_s->positive(), cutoff_s};
    }
    if (row_of(Id::ReloadForce)) {
      estimate.reloading = Reloading{positive_value(Id::ReloadForce), positive_value(Id::ReloadLength)};
    }
    if (const auto speed = document_.known("model", "stiffness_speed_m_per_s")) {
      estimate.stiffness_trend = StiffnessTrend{working_value(Id::StiffnessExponent), speed->positive()};
    }
    if (row_of(Id::Relaxation)) {
      const double share = working_value(Id::Relaxation);
      if (!(share >= 0.0 && share < 1.0)) refuse("relaxation is not between 0 and 1");
      estimate.relaxing = RelaxingSpring{share, positive_value(Id::RelaxationTime)};
    }
  }

  [[nodiscard]] std::optional<Estimate> kinetic_friction_N() const {
    const auto found = quantity_in(document_, quantity_with_key(info(ParameterId::KineticFriction).key));
    if (!found || !found->estimate.value) return std::nullopt;
    return Estimate{found->estimate.value, found->estimate.standard_error, std::nullopt, {}};
  }

  /// Student's t; without the key, or null, the normal distribution.
  [[nodiscard]] double degrees_of_freedom() const {
    const auto freedom = document_.known("model", "degrees_of_freedom");
    if (!freedom) return std::numeric_limits<double>::infinity();
    return freedom->number_that([](double value) { return value >= 1.0; }, "a number >= 1 or null");
  }

  /// Returns the speed range of a sweep.
  [[nodiscard]] std::optional<SpeedReach> reach() const {
    const auto speeds = document_.known("model", "speeds_m_per_s");
    if (!speeds) return std::nullopt;
    const std::string expected = "[slowest, fastest]";
    const std::vector<JsonNode> ends = speeds->elements(2, expected);
    SpeedReach reach{ends[0].positive(), ends[1].positive(), std::nullopt};
    if (reach.slowest_m_per_s > reach.fastest_m_per_s) speeds->fail(expected);
    if (const auto trend = document_.known("model", "trend_beyond")) reach.trend = trend->not_negative();
    return reach;
  }

  [[nodiscard]] ObservedEnd observed_end() const {
    const auto speeds = document_.known("derived", "observed_end_m_per_s");
    if (!speeds) return {};
    const std::vector<JsonNode> ends = speeds->elements(2, "[highest speed that sticks, lowest that does not]");
    return {ends[0].not_negative(), ends[1].not_negative()};
  }

  /// A coordinate of the model: its place in ModelEstimate::covariance, its row in the correlation, its standard error.
  struct Coordinate {
    std::size_t place = 0;
    std::size_t row = 0;
    double standard_error = 0.0;
  };

  /// Returns the four and what else the fit has; nothing if a standard error is null: in the list or, for a model of
  /// only four parameters, in the parameters.
  [[nodiscard]] std::vector<Coordinate> coordinates(const JsonNode& correlation, std::size_t size) const {
    constexpr double kLargestLogError = 10.0;  // a factor of e^20 either way, of a parameter that is said to be known
    // The logarithms that a prediction needs to know.
    constexpr std::array kLogarithmic{ParameterId::Stiffness, ParameterId::NaturalFrequency,
                                      ParameterId::FrictionDifference};
    std::vector<Coordinate> all;
    for (std::size_t place = 0; place < kModelParameters.size(); ++place) {
      const ParameterId id = kModelParameters[place];
      const std::optional<std::size_t> row = place < kNeeded.size() ? needed_row_of(id) : row_of(id);
      if (row) all.push_back({place, *row});
    }
    const bool has_only_four = all.size() == kNeeded.size();
    const std::vector<JsonNode> errors =
        correlation.member("scaled_se").elements(size, fmt::format("a list of {} numbers", size));
    for (Coordinate& one : all) {
      const ParameterId id = kModelParameters[one.place];
      const std::optional<double> error = errors[one.row].not_negative();
      if (error && std::ranges::find(kLogarithmic, id) != kLogarithmic.end() && *error > kLargestLogError) {
        errors[one.row].fail(fmt::format("a standard error of a logarithm, at most {}", kLargestLogError));
      }
      const bool is_open = status_of(parameter(id)) == ParameterStatus::Bounded;
      if (!error || (has_only_four && !is_open && parameter(id).member("se").is_null())) return {};
      one.standard_error = *error;
    }
    return all;
  }

  static std::vector<std::vector<double>> symmetric_matrix(const JsonNode& node, std::size_t size) {
    constexpr double kRounding = 1e-9;
    constexpr double kAsymmetry = 1e-6;
    std::vector<std::vector<double>> matrix;
    for (const JsonNode& row : node.elements(size, fmt::format("{} rows", size))) {
      matrix.emplace_back();
      for (const JsonNode& cell : row.elements(size, fmt::format("a row of {} numbers", size))) {
        matrix.back().push_back(
            cell.number_that([](double value) { return std::abs(value) <= 1.0 + kRounding; }, "a number from -1 to 1"));
      }
    }
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (std::abs(matrix[i][j] - matrix[j][i]) > kAsymmetry) node.fail("a symmetric matrix");
      }
      matrix[i][i] = 1.0;
    }
    return matrix;
  }

  /// Reads the covariance from standard errors and correlation; the model has none if an error is not known.
  void read_covariance(const JsonNode& correlation, PredictionModel& model) const {
    const std::size_t size = correlation.member("names").elements().size();
    const std::vector<Coordinate> all = coordinates(correlation, size);
    if (all.empty()) return;
    const std::vector<std::vector<double>> matrix = symmetric_matrix(correlation.member("matrix"), size);
    for (const Coordinate& a : all) {
      for (const Coordinate& b : all) {
        model.estimate.covariance[a.place][b.place] = a.standard_error * b.standard_error * matrix[a.row][b.row];
      }
    }
    model.has_covariance = true;
  }

  const JsonNode& document_;
  const std::string& name_;
};

std::string speed_unit_in(const JsonNode& document) {
  const std::vector<JsonNode> members = document.elements_of("recordings");
  const JsonNode& first = members.empty() ? document : members.front();
  return first.has("recording") ? first.member("recording").text_at("speed_unit") : std::string();
}

FitDocument fit_document_from(const JsonNode& document, const std::string& name) {
  FitDocument fit{ModelReader(document, name).model(), {}, warnings_in(document), speed_unit_in(document)};
  for (const JsonNode& condition : document.elements_of("model", "conditional_on")) {
    fit.conditional_on.push_back(condition.text());
  }
  return fit;
}

RecordingPlan plan_of(const JsonNode& recording) {
  constexpr double kMostSamples = 1e9;  // of a recording: more than any file that is read
  const RecordingPlan made{recording.member("speed_m_per_s").positive(), recording.member("sample_rate_Hz").positive(),
                           recording.member("duration_s").positive()};
  if (made.sample_rate_Hz * made.duration_s > kMostSamples) {
    recording.member("sample_rate_Hz").fail(fmt::format("at most {:g} samples in {} s", kMostSamples, made.duration_s));
  }
  return made;
}

/// The model, how the recordings with cycles were made, their noise and scatter (medians). Throws also where the
/// document has no residual in newtons.
PlanBasis plan_basis_of(const JsonNode& document, const ModelEstimate& estimate) {
  constexpr std::size_t kMostRecordings = 10000;  // of a sweep: a plan takes milliseconds for each
  PlanBasis result;
  result.estimate = estimate;
  if (!document.has("recordings")) {
    result.recordings = {plan_of(document.member("recording"))};
    result.noise_rms_N = document.member("model", "residual", "rms_N").positive();
    result.force_drop_sd_N = document.member("cycles", "force_drop_sd_N").number();
    return result;
  }
  if (document.member("model", "level_shared").flag().value_or(false)) result.levels = LevelSharing::Shared;
  const JsonNode recordings = document.member("recordings");
  const std::vector<JsonNode> members = recordings.elements();
  if (members.size() > kMostRecordings) recordings.fail(fmt::format("at most {} recordings", kMostRecordings));
  std::vector<double> noise;
  std::vector<double> scatter;
  for (const JsonNode& member : members) {
    if (member.member("role").text() != name_of(SweepRole::Cycles) || !member.has("joint")) continue;
    if (member.member("joint", "rms_N").is_null()) continue;
    result.recordings.push_back(plan_of(member.member("recording")));
    noise.push_back(member.member("joint", "rms_N").positive());
    if (const auto sd = member.member("cycles", "force_drop_sd_N").number()) scatter.push_back(*sd);
  }
  if (noise.empty()) recordings.fail("recordings with cycles in the joint fit");
  result.noise_rms_N = median(noise);
  if (!scatter.empty()) result.force_drop_sd_N = median(scatter);
  return result;
}

PlanBasis plan_basis_from(const JsonNode& document, const std::string& name) {
  const FitDocument fit = fit_document_from(document, name);
  if (!fit.model.has_covariance) {
    throw ThrownError(
        Error{"no_covariance",
              fmt::format("{}: has no covariance, which a plan needs: fit its recordings again with slipfit fit --json",
                          printable(name))});
  }
  return plan_basis_of(document, fit.model.estimate);
}

}  // namespace

std::optional<Error> check_fit_document(const std::string& content, const std::string& name) {
  const auto checked = with_document<bool>(content, name, [](const JsonNode&) { return true; });
  return checked ? std::nullopt : std::optional(checked.error());
}

Result<FitDocument> read_fit_document(const std::string& content, const std::string& name) {
  return with_document<FitDocument>(content, name,
                                    [&](const JsonNode& document) { return fit_document_from(document, name); });
}

Result<FitDocument> at_load(FitDocument document, double normal_force_N, const std::string& name) {
  if (!document.model.estimate.normal_force_N) {
    return Error{"no_normal_force",
                 fmt::format("--normal-force: the recordings of '{}' state no normal force; fit them again with "
                             "--normal-force or the manifest's normal_force_N",
                             printable(name))};
  }
  document.model = at_load(std::move(document.model), normal_force_N);
  document.conditional_on.push_back(
      fmt::format("friction in proportion to the normal force, here {:.6g} N", normal_force_N));
  return document;
}

Result<PlanBasis> read_plan_basis(const std::string& content, const std::string& name) {
  return with_document<PlanBasis>(content, name,
                                  [&](const JsonNode& document) { return plan_basis_from(document, name); });
}

}  // namespace slipfit
