#include "predict/critical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "predict/draws.hpp"

namespace slipfit::predict {
namespace {

/// Ends of stick-slip are sought between these limits, in units of the speed of a slip, (F_s - F_k) w_n / k. Damping of
/// 3e-6 ends stick-slip at the fastest, less than any recording shows.
constexpr double kSlowest = 1e-6;
constexpr double kFastest = 300.0;

struct SpeedRange {
  double slowest_m_per_s, fastest_m_per_s;
};

/// Returns the speeds between which ends are sought; empty where they are no numbers above 0.
std::optional<SpeedRange> searched_speeds(const ModelEstimate& model) {
  const double unit = model.natural_frequency_rad_per_s * model.friction_difference_N / model.stiffness_N_per_m;
  const SpeedRange range{kSlowest * unit, kFastest * unit};
  const bool is_range = range.slowest_m_per_s > 0.0 && std::isfinite(range.fastest_m_per_s);
  return is_range ? std::optional(range) : std::nullopt;
}

/// Returns the geometric mean. The product of two speeds may overflow.
double between(double low_m_per_s, double high_m_per_s) {
  const double product = low_m_per_s * high_m_per_s;
  return std::isnormal(product) ? std::sqrt(product) : std::sqrt(low_m_per_s) * std::sqrt(high_m_per_s);
}

/// How sharply ends are found, and by which share of a standard error parameters are moved for derivatives. A cycle on
/// a spring that relaxes settles slowly near its end.
struct Sharpness {
  double of_end, step;
};
Sharpness sharpness_of(const ModelEstimate& model) {
  return model.relaxing ? Sharpness{1e-6, 0.3} : Sharpness{1e-13, 0.005};
}

/// Two speeds with nothing between them: the model sticks at the lower one and not at the higher one.
struct Bracket {
  double sticks = 0.0, slides = 0.0;
};

double refined(const ModelEstimate& model, Bracket bracket, double sharp) {
  while (bracket.slides > (1.0 + sharp) * bracket.sticks) {
    const double middle = between(bracket.sticks, bracket.slides);
    if (!(middle > bracket.sticks && middle < bracket.slides)) break;
    (sticks_at(model, middle) ? bracket.sticks : bracket.slides) = middle;
  }
  return bracket.sticks;
}

/// Returns the end of a model near that of another which hardly differs from it; empty where there is none.
std::optional<double> end_near(const ModelEstimate& model, double near_m_per_s) {
  constexpr double kFarthest = 2.0;
  for (double distance = 1e-3; distance < kFarthest; distance *= 4.0) {  // of ln V
    const Bracket bracket{near_m_per_s * std::exp(-distance), near_m_per_s * std::exp(distance)};
    if (sticks_at(model, bracket.sticks) && !sticks_at(model, bracket.slides)) {
      return refined(model, bracket, sharpness_of(model).of_end);
    }
  }
  return std::nullopt;
}

/// Returns the end with its derivatives, by differences to either side.
std::optional<Jet> end_with_derivatives(const ModelEstimate& model, double end_m_per_s) {
  constexpr double kSmallStep = 1e-3;  // of the first four where they are held: other speeds may widen them
  Jet end(end_m_per_s);
  for (std::size_t i = 0; i < kModelValues; ++i) {
    const ParameterId id = kModelParameters[i];
    if (model.find(id) == nullptr) continue;
    const double error = std::sqrt(model.covariance[i][i]);
    const double step = error > 0.0                                 ? sharpness_of(model).step * error
                        : i < std::size(SingleSpeed{}.least_errors) ? kSmallStep
                                                                    : 0.0;
    if (step == 0.0) continue;
    const auto end_after = [&](double move) {
      ModelEstimate other = model;
      double& value = *other.find(id);
      value = moved(id, value, move);
      return end_near(other, end_m_per_s);
    };
    const std::optional<double> above = end_after(step);
    const std::optional<double> below = end_after(-step);
    if (!above || !below) return std::nullopt;
    end.v[static_cast<Eigen::Index>(i)] = (*above - *below) / (2.0 * step);
  }
  return end;
}

/// Finds the ends of stick-slip of the models that the covariance of one allows. A quantile asks each model only at
/// speeds that may decide on which side of it its end lies, few of them more than twice.
class EndsOfDraws {
 public:
  /// `near_m_per_s`: the end of `model`, where the search begins; 0 or infinite where there is none.
  EndsOfDraws(const ModelEstimate& model, const SpeedRange& range, double near_m_per_s)
      : slowest_(range.slowest_m_per_s),
        fastest_(range.fastest_m_per_s),
        near_(std::clamp(near_m_per_s, 2.0 * slowest_, 0.5 * fastest_)) {
    for (const ModelEstimate& draw : draws_of(model)) draws_.push_back({draw, 0.0, HUGE_VAL});
  }

  /// Returns the speed below which this share of the models ends stick-slip, accurate to 1e-3 of it; 0 where the model
  /// at this share has no stick-slip at any speed, infinite where it has stick-slip at every speed.
  [[nodiscard]] double quantile_m_per_s(double share) {
    constexpr double kSharpQuantile = 1e-3;
    if (draws_.empty()) return 0.0;
    const auto most_below = static_cast<std::size_t>(share * static_cast<double>(draws_.size() - 1));
    const auto is_above = [&](double speed_m_per_s) { return ending_below(speed_m_per_s) <= most_below; };
    double low = near_;
    double high = near_;
    if (is_above(near_)) {
      for (double step = 2.0; is_above(high); step *= step) {
        if (high == fastest_) return HUGE_VAL;
        low = high;
        high = std::min(fastest_, high * step);
      }
    } else {
      for (double step = 2.0; !is_above(low); step *= step) {
        if (low == slowest_) return 0.0;
        high = low;
        low = std::max(slowest_, low / step);
      }
    }
    while (high > (1.0 + kSharpQuantile) * low) {
      const double middle = between(low, high);
      (is_above(middle) ? low : high) = middle;
    }
    return low;
  }

 private:
  struct Draw {
    ModelEstimate model;
    double sticks_m_per_s;  ///< the highest speed known to
    double slides_m_per_s;  ///< the lowest
  };

  std::size_t ending_below(double speed_m_per_s) {
    constexpr double kRough = 1e-3;  // of the static friction of the limit cycle, whose existence alone counts
    std::size_t count = 0;
    for (Draw& draw : draws_) {
      if (draw.sticks_m_per_s < speed_m_per_s && speed_m_per_s < draw.slides_m_per_s) {
        (sticks_at(draw.model, speed_m_per_s, kRough) ? draw.sticks_m_per_s : draw.slides_m_per_s) = speed_m_per_s;
      }
      if (draw.slides_m_per_s <= speed_m_per_s) ++count;
    }
    return count;
  }

  double slowest_;
  double fastest_;
  double near_;
  std::vector<Draw> draws_;
};

/// Returns the critical point over the models that the covariance allows, for use where linear propagation is not
/// valid. `why` says that it is not, or has nothing to say; it is the answer where the models do not determine more.
/// `end_m_per_s` is the end of `model` itself, infinite or 0 where it has none.
CriticalPoint by_draws(const ModelEstimate& model, const std::string& why, double end_m_per_s) {
  constexpr std::size_t kZeta = place_in_model(ParameterId::DampingRatio);
  constexpr double kTail = 0.025;
  // Without an error zeta says nothing: it may lie anywhere.
  const bool may_be_anywhere = !model.damping_identified && !(model.covariance[kZeta][kZeta] > 0.0);
  const std::optional<SpeedRange> range = searched_speeds(model);
  if (may_be_anywhere || !range) return CriticalPoint::unknown(why);
  EndsOfDraws ends(model, *range, end_m_per_s);
  const double low = ends.quantile_m_per_s(kTail);
  // Where zeta may be 0, no draw is exactly that.
  const bool is_damped = model.damping_identified && model.damping_ratio > 0.0;
  const double high = is_damped ? ends.quantile_m_per_s(1.0 - kTail) : HUGE_VAL;
  CriticalPoint point = CriticalPoint::unknown(why);
  if (!(low > 0.0) || std::isinf(low)) return point;
  Estimate& speed = point.speed_m_per_s;
  speed.ci95 = Interval{low, high};
  if (std::isinf(high)) return point;
  speed.value = low < end_m_per_s && end_m_per_s < high ? end_m_per_s : between(low, high);
  speed.standard_error = 0.5 * *speed.value * std::log(high / low) / kNormalQuantile;
  speed.note.clear();
  return point;
}

/// Says that the model's law of friction is not known well enough: of static friction, or else of F_k(v).
const char* open_law(const ModelEstimate& model) {
  return model.ageing ? "ageing and damping are not known well enough to tell where stick-slip ends"
                      : "damping and friction law are not known well enough to tell where stick-slip ends";
}

bool has_law(const ModelEstimate& model) {
  return model.ageing || model.speed_dependence;
}

CriticalPoint without_end(const ModelEstimate& model) {
  if (model.ageing) return by_draws(model, "there is stick-slip at every speed looked at", HUGE_VAL);
  if (!model.damping_identified) return CriticalPoint::unknown("the damping ratio cannot be distinguished from 0");
  return {{0.0, std::nullopt, std::nullopt, {}},
          unknown(model.damping_ratio > 0.0 ? "there is stick-slip at every speed looked at"
                                            : "without damping there is stick-slip at every speed")};
}

/// The end of stick-slip of a model, with its derivatives where there are any.
struct End {
  double speed_m_per_s = 0.0;  ///< 0: no stick-slip; infinite: no end
  std::optional<Jet> speed{};
  double difference_N = 0.0;  ///< F_s - F_k(0+) of the slips there
};

End end_of(const ModelEstimate& model) {
  End end{end_of_stick_slip_m_per_s(model, sharpness_of(model).of_end)};
  if (end.speed_m_per_s == 0.0 || std::isinf(end.speed_m_per_s)) return end;
  end.speed = end_with_derivatives(model, end.speed_m_per_s);
  const std::optional<Plain> aged_N = body_at<Plain>(model, end.speed_m_per_s).aged_difference_N();
  end.difference_N = aged_N ? aged_N->a : model.friction_difference_N;
  return end;
}

/// Returns the critical point by the covariance of `model`, whose own stick-slip has this end.
CriticalPoint point_of(const ModelEstimate& model, const End& end) {
  if (!has_law(model) && !model.damping_identified) {
    return by_draws(model, "the damping ratio cannot be distinguished from 0", end.speed_m_per_s);
  }
  if (std::isinf(end.speed_m_per_s)) return without_end(model);
  if (end.speed_m_per_s == 0.0) {
    if (has_law(model)) return CriticalPoint::unknown("no stick-slip at any speed");
    const std::string reason = "no stick-slip at any speed: the damping ratio is not below 1";
    return {unknown(reason), {0.0, std::nullopt, std::nullopt, reason}};
  }
  const Propagation propagation(model);
  const double widest = (model.ageing ? 2.0 : 1.0) * std::log(thresholds::kWidestFactor);
  const bool is_wide =
      !end.speed ||
      (has_law(model) && propagation.quantile() * propagation.standard_error(*end.speed) > widest * end.speed_m_per_s);
  if (is_wide && model.ageing) return by_draws(model, open_law(model), end.speed_m_per_s);
  if (is_wide || propagation.law_is_open_at(end.speed_m_per_s)) return CriticalPoint::unknown(open_law(model));
  // The logarithm of the speed is nearly linear in the parameters.
  const model::SlidingBody<Jet> body = body_at<Jet>(model, end.speed_m_per_s);
  const Jet difference_N = model.ageing ? Jet(end.difference_N) : body.difference_N;
  const Jet lambda = body.omega_rad_per_s * difference_N / (body.stiffness_N_per_m * *end.speed);
  return {propagation.positive(lambda), propagation.positive(*end.speed)};
}

/// Returns the critical point if all that is known is that it lies above a speed: no farther outside the recordings
/// than any law is valid.
CriticalPoint bound_of(const ModelEstimate& model, double least_m_per_s, const End& end) {
  const std::optional<ModelEstimate> wider = beyond(model, least_m_per_s);
  if (!wider) return CriticalPoint::unknown(kUntrended);
  CriticalPoint point = point_of(*wider, end);
  std::optional<Interval>& bounds = point.speed_m_per_s.ci95;
  if (has_law(model) && bounds && model.reach) {
    bounds->low = std::min(bounds->low, thresholds::kUntrendedRatio * model.reach->fastest_m_per_s);
  }
  return point;
}

}  // namespace

double end_of_stick_slip_m_per_s(const ModelEstimate& model, double sharp) {
  constexpr double kSearchStep = 1.1;
  const std::optional<SpeedRange> range = searched_speeds(model);
  if (!range) return 0.0;
  const auto [slowest, fastest] = *range;
  if (sticks_at(model, fastest)) return HUGE_VAL;
  // Friction that depends on the speed, or falls with the time at rest, lets stick-slip begin at some speed.
  const bool may_begin = model.speed_dependence || (model.ageing && model.ageing->rate_N < 0.0);
  const double step = may_begin ? kSearchStep : fastest / slowest;
  double slides = fastest;
  while (!sticks_at(model, slides / step)) {
    slides /= step;
    if (slides <= slowest) return 0.0;
  }
  return refined(model, {slides / step, slides}, sharp);
}

CriticalPoint critical_point(const ModelEstimate& model) {
  if (model.ageing && model.relaxing) {
    return CriticalPoint::unknown(
        "the end of stick-slip is not computed for a spring that relaxes and static friction that ages");
  }
  const End end = end_of(model);
  CriticalPoint point = point_of(model, end);
  const std::optional<double> speed = point.speed_m_per_s.value;
  if (!model.reach && !model.single_speed) return point;
  if (!speed && point.speed_m_per_s.ci95) return bound_of(model, point.speed_m_per_s.ci95->low, end);
  if (!speed || !(*speed > 0.0)) return point;
  const double distance = model.reach ? model.reach->distance_to(*speed) : 0.0;
  const std::optional<ModelEstimate> wider = beyond(model, *speed);
  if (!wider) {
    point.speed_m_per_s = unknown(kUntrended);
  } else if (has_law(model) && distance > std::log(thresholds::kUntrendedRatio)) {
    point.speed_m_per_s =
        unknown(fmt::format("the law of {} friction puts it at {:.4g} m/s, a factor of {:.2g} beyond the recordings: "
                            "another law that fits them as well puts it elsewhere",
                            model.ageing ? "static" : "kinetic", *speed, std::exp(distance)));
  } else {
    return point_of(*wider, end);
  }
  return point;
}

}  // namespace slipfit::predict
