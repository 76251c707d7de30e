#include "fit/cycle/cycle_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/thresholds.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/law/speed_dependent.hpp"

namespace slipfit::fit {
namespace {

/// A coordinate by which ln k differs from cycle to cycle. ln w_n of the same mass differs by half of it, ln zeta by a
/// multiple. docs/model.md (26), (26a)
struct Growth {
  Coordinate coordinate{};
  double of_log_damping = 0.0;
};
constexpr std::array kGrowths{Growth{kStiffnessExponent, 0.0}, Growth{kStiffnessDrift, -0.5}};

}  // namespace

Columns::Columns(const Scales& scales, const LevelModel& level)
    : has_constant_(level.terms > 0 || scales.population.has_value()),
      drift_(level.columns_behind_constant()),
      own_(level.per_cycle ? 3 : 2) {
  const auto add = [&](Coordinate coordinate) {
    column_[index(coordinate)] = coordinates_.size();
    coordinates_.push_back(coordinate);
  };
  for (const Coordinate always : {kLogStiffness, kLogFrequency, kDamping}) add(always);
  if (depends_on_speed(scales.law)) {
    add(kFrictionSlope);
    add(kFrictionRate);
  }
  if (scales.law == FrictionLaw::Weakening) add(kSlipDistance);
  if (scales.relaxing) {
    add(kRelaxation);
    add(kRelaxationTime);
  }
  if (level.reloading) add(kReloadForce);
  if (level.reloading && level.reloading->is_free) add(kReloadLength);
  if (scales.population && scales.population->log_speed) add(kStiffnessExponent);
  if (scales.stiffness_drifts) add(kStiffnessDrift);
  if (scales.free_time != FreeTime::None) add(kSensorTime);
  if (scales.population) add(kDifference);
}

SensorTimes sensor_of(const Scales& scales, const Coordinates& values) {
  SensorTimes sensor{scales.sensor_lag_s, scales.sensor_average_s, scales.sensor_order};
  if (scales.free_time == FreeTime::None) return sensor;
  double& time_s = scales.free_time == FreeTime::Lag ? sensor.lag_s : sensor.average_s;
  time_s = scales.sensor_time_unit_s * std::sqrt(values(kSensorTime));
  return sensor;
}

CycleModel::CycleModel(const CycleSet& set, std::size_t cycle, const Scales& scales, const Columns& columns)
    : data_(&set.cycles()[cycle]),
      level_(&set.level()),
      rows_(&set.rows(cycle)),
      columns_(&columns),
      scales_(scales),
      reference_s_(set.reference_s()[cycle]),
      even_step_s_(set.even_step_s(cycle)) {}

double CycleModel::share_of(Coordinate coordinate) const {
  if (coordinate == kStiffnessExponent) return *scales_.population->log_speed;
  return scales_.place_at(reference_s_);
}

Coordinates CycleModel::of_cycle(const Coordinates& shared) const {
  Coordinates here = shared;
  for (const Growth& growth : kGrowths) {
    if (!columns_->has(growth.coordinate)) continue;
    const double of_log_stiffness = shared(growth.coordinate) * share_of(growth.coordinate);
    here(kLogStiffness) += of_log_stiffness;
    here(kLogFrequency) += 0.5 * of_log_stiffness;
    here(kDamping) *= std::exp(growth.of_log_damping * of_log_stiffness);
  }
  return here;
}

CycleFrame CycleModel::frame(const Coordinates& here, const double* local) const {
  CycleFrame frame;
  frame.stiffness_N_per_m = std::exp(here(kLogStiffness));
  frame.omega_rad_per_s = std::exp(here(kLogFrequency));
  frame.zeta = here(kDamping);
  frame.force_scale = frame.stiffness_N_per_m * scales_.speed_m_per_s / frame.omega_rad_per_s;
  frame.onset_s = reference_s_ + scales_.half_period_s * local[0];
  frame.onset_force = scales_.force * local[1];
  return frame;
}

std::optional<CycleRise> CycleModel::rise(const Coordinates& shared) const {
  if (!level_->reloading) return std::nullopt;
  const double average_s = sensor_of(scales_, shared).average_s;
  return CycleRise{scales_.force * shared(kReloadForce),
                   RiseAroundSlip(*level_->reloading, data_->slip, std::exp(shared(kReloadLength)), average_s)};
}

StickBend CycleModel::bend(const Coordinates& shared) const {
  const double curvature = columns_->has(kStiffnessDrift)
                               ? shared(kStiffnessDrift) * curvature_by_drift(std::exp(of_cycle(shared)(kLogStiffness)))
                               : 0.0;
  return {rise(shared), curvature, StickEnds(reference_s_, scales_)};
}

StickBend::Line StickBend::over(const StickBin& bin) const {
  const double from_slip_s = ends.from_slip(bin.time_s);
  const double spread = bin.count > 0.0 ? bin.time_spread / bin.count : 0.0;
  Line line{0.5 * curvature * (from_slip_s * from_slip_s + spread), curvature * from_slip_s};
  if (!rise) return line;
  const RiseAfterSlip::Line of_rise = rise->share.over(bin);
  line.mean += rise->force * of_rise.mean.value;
  line.slope += rise->force * of_rise.slope.value;
  return line;
}

std::optional<CycleState> CycleModel::state(const Coordinates& shared, const double* local) const {
  const Coordinates here = of_cycle(shared);
  const CycleFrame f = frame(here, local);
  const SensorTimes sensor = sensor_of(scales_, here);
  if (scales_.law == FrictionLaw::Weakening) {
    auto motion = WeakeningCycle::solve(f.z0(), f.omega_rad_per_s, here, sensor, scales_);
    return motion ? std::optional(CycleState{f, *std::move(motion)}) : std::nullopt;
  }
  if (scales_.relaxing) {
    auto motion = RelaxingCycle::solve(f.z0(), f.omega_rad_per_s, here, sensor, scales_);
    return motion ? std::optional(CycleState{f, *std::move(motion)}) : std::nullopt;
  }
  if (!(f.z0() + 2.0 * f.zeta > 0.0) || !(std::abs(f.zeta) < 1.0) || !std::isfinite(f.z0())) return std::nullopt;
  CoulombCycle motion(f.z0(), f.zeta, sensor.in_tau(f.omega_rad_per_s), scales_.view);
  if (!(motion.tau_end() < CoulombWave::kLongest)) return std::nullopt;
  return CycleState{f, std::move(motion)};
}

namespace {

/// Returns, for every residual row, what sticks that bend have more than straight ones.
Eigen::ArrayXd rows_of(const StickBend& bend, const CycleData& data) {
  Eigen::ArrayXd rows(static_cast<Eigen::Index>(data.residuals()));
  Eigen::Index row = 0;
  for (const double time_s : data.time_s) rows(row++) = bend.at(time_s);
  for (const auto* bins : {&data.bins_before, &data.bins_after}) {
    for (const StickBin& bin : *bins) {
      const StickBend::Line line = bend.over(bin);
      rows(row++) = line.mean;
      rows(row++) = line.slope;
    }
  }
  return rows;
}

}  // namespace

/// Forms residuals and their Jacobian column by column, as the processor's vectors do it several rows at a time. The
/// rows first store the ingredients of a column in the place of that column.
class CycleModel::Rows {
  using Index = Eigen::Index;
  using Column = Eigen::Map<Eigen::ArrayXd>;
  using Jacobian = Eigen::Map<Eigen::ArrayXXd>;

 public:
  Rows(const CycleModel& cycle, const CycleValues& values, double* residuals, double* jacobian)
      : cycle_(cycle),
        scales_(cycle.scales_),
        rows_(*cycle.rows_),
        values_(values),
        residuals_(residuals),
        jacobian_(jacobian),
        columns_(cycle.columns()),
        stride_(static_cast<Index>(cycle.residuals())),
        drift_(static_cast<Index>(columns_.first_drift())),
        onset_(static_cast<Index>(columns_.common())) {}

  /// What a row stores: the force above the level and its derivatives, in units of k V / w_n.
  template <std::size_t N>
  struct Ingredients {
    double z = 0.0, by_tau = 0.0, by_z0 = 0.0;
    double by_log_omega = 0.0;  ///< at a fixed time
    double by_log_time = 0.0;   ///< of the sensor
    std::array<double, N> by_law{};

    void add(double weight, const Ingredients& other) {
      z += weight * other.z;
      by_tau += weight * other.by_tau;
      by_z0 += weight * other.by_z0;
      by_log_omega += weight * other.by_log_omega;
      by_log_time += weight * other.by_log_time;
      for (std::size_t i = 0; i < N; ++i) by_law[i] += weight * other.by_law[i];
    }
  };
  /// Places of the ingredients at the next row.
  struct Place {
    double* z = nullptr;
    double* by_tau = nullptr;
    double* by_z0 = nullptr;
    double* by_log_omega = nullptr;    ///< at a fixed time
    double* by_sensor_time = nullptr;  ///< null where none is free
    double* by_law = nullptr;          ///< one after the other at distances `stride`
    std::ptrdiff_t stride = 0;
    std::ptrdiff_t row = 0;

    template <std::size_t N>
    void put(const Ingredients<N>& at) {
      const std::ptrdiff_t here = row++;
      z[here] = at.z;
      if (by_tau == nullptr) return;
      by_tau[here] = at.by_tau;
      by_z0[here] = at.by_z0;
      by_log_omega[here] = at.by_log_omega;
      if (by_sensor_time != nullptr) by_sensor_time[here] = at.by_log_time;
      double* law = by_law + here;
      for (const double derivative : at.by_law) {
        *law = derivative;
        law += stride;
      }
    }
  };
  [[nodiscard]] Place first() const {
    if (jacobian_ == nullptr) return {residuals_, nullptr, nullptr, nullptr, nullptr, nullptr, stride_};
    double* const by_time = columns_.has(kSensorTime) ? at(of(kSensorTime)) : nullptr;
    return {residuals_, at(onset_), at(onset_ + 1), at(kLogFrequency), by_time, at(kDamping), stride_};
  }

  /// Turns what the rows have stored into residuals and Jacobian.
  void finish(const CycleFrame& frame) const {
    const double by_noise = 1.0 / scales_.noise;
    const double u = frame.force_scale;
    const Column z(residuals_, rows_.force.size());
    const Eigen::ArrayXd bend = columns_.has(kStiffnessDrift) ? by_drift(frame, by_noise) : Eigen::ArrayXd();
    if (jacobian_ != nullptr) differentiate(frame, z, by_noise, bend);
    Column(residuals_, z.size()) =
        by_noise * (rows_.weight * (rows_.force - u * z) - constant_force() * rows_.level_weight);
    if (columns_.has(kStiffnessDrift)) {
      Column(residuals_, z.size()) -= (*values_.shared)(kStiffnessDrift)*bend;
    }
    for (Index i = 0; i < rows_.level.cols(); ++i) {
      Column(residuals_, z.size()) -= by_noise * scales_.force * values_.drift[i] * rows_.weight * rows_.level.col(i);
    }
  }

  /// The rise after slips joins residuals and Jacobian.
  void add_rise(const CycleRise& rise) const {
    Index row = 0;
    const auto put = [&](const RiseAfterSlip::Share& share) {
      const double by_force = -scales_.force / scales_.noise * rows_.weight(row);
      const double by_share = by_force * (*values_.shared)(kReloadForce);
      residuals_[row] += by_share * share.value;
      if (jacobian_ != nullptr) {
        at(of(kReloadForce))[row] = by_force * share.value;
        if (columns_.has(kReloadLength)) at(of(kReloadLength))[row] = by_share * share.by_log_length;
        if (scales_.free_time == FreeTime::Average) {
          at(of(kSensorTime))[row] += by_share * share.by_log_average * 0.5 / (*values_.shared)(kSensorTime);
        }
      }
      ++row;
    };
    const CycleData& data = cycle_.data();
    for (const double time_s : data.time_s) put(rise.share.at(time_s));
    for (const auto* bins : {&data.bins_before, &data.bins_after}) {
      for (const StickBin& bin : *bins) {
        const RiseAfterSlip::Line line = rise.share.over(bin);
        put(line.mean);
        put(line.slope);
      }
    }
  }

  /// F_s of this cycle against the population's: A + c V - (F_s - F_k(0+)).
  void tie_static_friction(const CycleFrame& frame, Index row) const {
    const double weight = 1.0 / scales_.population->onset_sd;
    const double drag = 2.0 * frame.zeta * frame.force_scale;
    const Coordinates& shared = *values_.shared;
    const double onset_force = scales_.population->force * shared(kDifference);
    residuals_[row] = weight * (onset_force - frame.onset_force - drag);
    if (jacobian_ == nullptr) return;
    Jacobian::RowXpr line = cleared(row);
    line(kLogStiffness) = -weight * drag;
    line(kLogFrequency) = weight * drag;
    line(kDamping) = -weight * 2.0 * frame.force_scale;
    add_growths(frame, [&line](Index i) { return line.segment<1>(i); });
    line(of(kDifference)) = weight * scales_.population->force;
    line(onset_ + 1) = -weight * scales_.force;
  }

  /// A level of its own against the population's.
  void tie_level(Index row) const {
    const double weight = 1.0 / scales_.population->level_sd;
    const double unit = scales_.population->force;
    residuals_[row] = weight * (unit * *values_.constant - scales_.level - scales_.force * values_.local[2]);
    if (jacobian_ == nullptr) return;
    Jacobian::RowXpr line = cleared(row);
    line(constant()) = weight * unit;
    line(onset_ + 2) = -weight * scales_.force;
  }

 private:
  [[nodiscard]] double* at(Index column) const { return jacobian_ + column * stride_; }
  /// Returns the column of a coordinate that the fit solves for.
  [[nodiscard]] Index of(Coordinate coordinate) const { return static_cast<Index>(*columns_.find(coordinate)); }
  [[nodiscard]] Index constant() const { return drift_ - 1; }
  /// Returns the part of a column that holds the rows that are not ties.
  [[nodiscard]] Column column(Index column) const { return {at(column), rows_.force.size()}; }
  [[nodiscard]] double constant_force() const {
    return cycle_.level_->per_cycle ? scales_.level + scales_.force * values_.local[2]
                                    : scales_.level_zero() + scales_.level_unit() * *values_.constant;
  }

  /// `bend`: by_drift, where the fit solves for it.
  void differentiate(const CycleFrame& frame, const Column& z, double by_noise, const Eigen::ArrayXd& bend) const {
    const Eigen::ArrayXd& weight = rows_.weight;
    const bool per_cycle = cycle_.level_->per_cycle;
    const double scaled = -by_noise * frame.force_scale;
    column(kLogStiffness) = scaled * weight * (z - frame.z0() * column(onset_ + 1));  // at a fixed tau
    column(kLogFrequency) = scaled * weight * column(kLogFrequency) - column(kLogStiffness);
    if (columns_.has(kStiffnessDrift)) {
      column(kLogStiffness) -= (*values_.shared)(kStiffnessDrift)*bend;
    }
    for (const Coordinate of_law :
         {kDamping, kFrictionSlope, kFrictionRate, kSlipDistance, kRelaxation, kRelaxationTime}) {
      if (columns_.has(of_law)) column(of(of_law)) *= scaled * weight;
    }
    add_growths(frame, [this](Index i) { return column(i); });
    if (columns_.has(kStiffnessDrift)) column(of(kStiffnessDrift)) -= bend;
    if (columns_.has(kSensorTime)) column(of(kSensorTime)) *= 0.5 / (*values_.shared)(kSensorTime)*scaled * weight;
    if (columns_.has(kDifference)) column(of(kDifference)).setZero();
    if (columns_.has_constant() && per_cycle) column(constant()).setZero();
    if (columns_.has_constant() && !per_cycle) {
      column(constant()) = -by_noise * scales_.level_unit() * rows_.level_weight;
    }
    for (Index i = 0; i < rows_.level.cols(); ++i) {
      column(drift_ + i) = -by_noise * scales_.force * weight * rows_.level.col(i);
    }
    column(onset_) *= -scaled * frame.omega_rad_per_s * scales_.half_period_s * weight;
    column(onset_ + 1) *= -by_noise * scales_.force * weight;
    if (per_cycle) column(onset_ + 2) = -by_noise * scales_.force * rows_.level_weight;
  }

  /// Fills the derivatives with respect to what makes k differ from cycle to cycle, and turns that with respect to the
  /// cycle's zeta into that with respect to the shared one. `part_of`: of a column.
  template <class PartOf>
  void add_growths(const CycleFrame& frame, const PartOf& part_of) const {
    for (const Growth& growth : kGrowths) {
      if (!columns_.has(growth.coordinate)) continue;
      const double share = cycle_.share_of(growth.coordinate);
      auto of_damping = part_of(kDamping);
      part_of(of(growth.coordinate)) = share * (part_of(kLogStiffness) + 0.5 * part_of(kLogFrequency) +
                                                growth.of_log_damping * frame.zeta * of_damping);
      of_damping *= std::exp(growth.of_log_damping * (*values_.shared)(growth.coordinate) * share);
    }
  }

  /// Returns what k that changes within the sticks adds to the model, per kStiffnessDrift.
  [[nodiscard]] Eigen::ArrayXd by_drift(const CycleFrame& frame, double by_noise) const {
    const StickBend bend{
        {}, cycle_.curvature_by_drift(frame.stiffness_N_per_m), StickEnds(cycle_.reference_s_, scales_)};
    return by_noise * rows_.weight * rows_of(bend, cycle_.data());
  }

  [[nodiscard]] Jacobian::RowXpr cleared(Index row) const {
    Jacobian jacobian(jacobian_, stride_, static_cast<Index>(columns_.size()));
    jacobian.row(row).setZero();
    return jacobian.row(row);
  }

  const CycleModel& cycle_;
  const Scales& scales_;
  const CycleRows& rows_;
  const CycleValues values_;
  double* residuals_;
  double* jacobian_;
  const Columns& columns_;
  Index stride_;
  Index drift_, onset_;  ///< first column of each
};

/// F = level + u z(tau; z0, law), tau = w_n (t - onset), z0 = A / u, u = k V / w_n
template <class Law>
void CycleModel::fill(const Law& law, const CycleFrame& frame, const std::optional<CycleRise>& rise,
                      const Rows& rows) const {
  using Point = typename Law::Point;
  using ByLaw = decltype(std::declval<const Law&>().by_law(std::declval<const Point&>()));
  using Ingredients = Rows::Ingredients<std::tuple_size_v<ByLaw>>;
  Rows::Place next = rows.first();
  const bool is_lag = scales_.free_time == FreeTime::Lag;
  const auto ingredients = [&](double tau, const Point& p) {
    // What depends on w_n at fixed tau are the times of the sensor: what is not the average's is the lag's.
    const double by_log_time = is_lag ? p.d_log_omega - p.d_log_average : p.d_log_average;
    return Ingredients{p.z, p.d_tau, p.d_z0, p.d_tau * tau + law.by_log_omega(p), by_log_time, law.by_law(p)};
  };
  typename Law::Samples samples(law, frame.omega_rad_per_s * even_step_s_);
  for (const double time_s : data_->time_s) {
    const double tau = frame.tau_at(time_s);
    next.put(ingredients(tau, samples.at(tau)));
  }
  if constexpr (Law::kStraightSticks) {
    const auto put_bin = [&](double tau, const Point& p) {
      next.put(ingredients(tau, p));
      // The slope of a stick is k V: w_n in these units, so that it does not change with w_n.
      const double w = frame.omega_rad_per_s;
      next.put(Ingredients{w, 0.0, 0.0, w, 0.0, ByLaw{}});
    };
    const auto tau_of = [&](const StickBin& bin) { return frame.tau_at(bin.time_s); };
    for (const StickBin& bin : data_->bins_before) put_bin(tau_of(bin), law.before_slip(tau_of(bin)));
    for (const StickBin& bin : data_->bins_after) put_bin(tau_of(bin), law.after_slip(tau_of(bin)));
  } else {
    for (const auto* bins : {&data_->bins_before, &data_->bins_after}) {
      for (const StickBin& bin : *bins) {
        Ingredients mean;
        Ingredients slope;
        const BinNodes in_bin(bin);
        for (const BinNodes::Node& node : in_bin.nodes()) {
          const double tau = frame.tau_at(node.time_s);
          const Ingredients here = ingredients(tau, law.at(tau));
          mean.add(node.mean, here);
          slope.add(node.slope_per_s, here);
        }
        next.put(mean);
        next.put(slope);
      }
    }
  }
  rows.finish(frame);
  if (rise) rows.add_rise(*rise);
  if (!scales_.population) return;
  const auto ties = static_cast<Eigen::Index>(data_->residuals());
  rows.tie_static_friction(frame, ties);
  if (level_->per_cycle) rows.tie_level(ties + 1);
}

bool CycleModel::evaluate(const CycleValues& values, double* residuals, double* jacobian) const {
  Rows rows(*this, values, residuals, jacobian);
  const std::optional<CycleRise> rise = this->rise(*values.shared);
  if (!is_integrated()) {
    const std::optional<CycleState> now = state(*values.shared, values.local);
    if (now) std::visit([&](const auto& law) { fill(law, *now, rise, rows); }, now->motion);
    return now.has_value();
  }
  const Coordinates here = of_cycle(*values.shared);
  const CycleFrame f = frame(here, values.local);
  const auto motion = SpeedDependentCycle::solve(f.z0(), here, sensor_of(scales_, here), scales_);
  if (motion) fill(*motion, f, rise, rows);
  return motion.has_value();
}

void legendre(double x, std::size_t terms, double* values) {
  for (std::size_t n = 0; n < terms; ++n) {
    const auto order = static_cast<double>(n);
    values[n] = n == 0   ? 1.0
                : n == 1 ? x
                         : ((2.0 * order - 1.0) * x * values[n - 1] - (order - 1.0) * values[n - 2]) / order;
  }
}

namespace {

/// The derivatives of the polynomials: P'_n = P'_(n-2) + (2n - 1) P_(n-1).
void differentiate_legendre(const std::vector<double>& values, std::vector<double>& derivatives) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double before = n >= 2 ? derivatives[n - 2] : 0.0;
    derivatives[n] = n == 0 ? 0.0 : (2.0 * static_cast<double>(n) - 1.0) * values[n - 1] + before;
  }
}

constexpr double kLeastTolerance = 1e-9;  // of a step: what is left of binary fractions

/// The step of times that are even to `tolerance_s`, some of which may be left out; 0 of others: an uneven clock.
double even_step_of(const std::vector<double>& time_s, double tolerance_s) {
  if (time_s.size() < 2) return 0.0;
  const double span_s = time_s.back() - time_s.front();
  double smallest_s = span_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) smallest_s = std::min(smallest_s, time_s[i] - time_s[i - 1]);
  if (!(smallest_s > 0.0)) return 0.0;
  // From neighbour to neighbour: over the whole span what times are rounded by may add up to a step.
  std::vector<double> steps{0.0};
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps.push_back(steps.back() + std::round((time_s[i] - time_s[i - 1]) / smallest_s));
  }
  const double step_s = span_s / steps.back();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double off_s = time_s[i] - time_s.front() - step_s * steps[i];
    if (std::abs(off_s) > std::max(kLeastTolerance * step_s, tolerance_s)) return 0.0;
  }
  return step_s;
}

/// Returns the rounding of written times, in s, that changes the force on the steepest part of a slip by kOfNoise of
/// the noise.
double tolerated_rounding_s(const Scales& scales) {
  constexpr double kOfNoise = 0.01;
  return kOfNoise * scales.noise / scales.force * scales.half_period_s / std::numbers::pi;
}

/// The level's functions but for the constant: at a time, or mean and slope over a bin.
class LevelRow {
 public:
  LevelRow(const LevelModel& level, const Scales& scales)
      : level_(level), scales_(scales), values_(level.terms), slopes_(level.terms) {}

  /// `out`: a row of CycleRows::level.
  template <class Row>
  void at(double time_s, Row out) {
    Eigen::Index column = put_polynomial(time_s, out);
    for (const double line_Hz : level_.lines_Hz) {
      const double phase = 2.0 * std::numbers::pi * line_Hz * (time_s - scales_.time_begin_s);
      out(column++) = std::cos(phase);
      out(column++) = std::sin(phase);
    }
  }

  /// `mean`, `slope`: rows.
  template <class Row>
  void over(const StickBin& bin, Row mean, Row slope) {
    Eigen::Index column = put_polynomial(bin.time_s, mean);
    differentiate_legendre(values_, slopes_);
    for (std::size_t i = 1; i < level_.terms; ++i)
      slope(static_cast<Eigen::Index>(i) - 1) = 2.0 / span_s() * slopes_[i];
    for (const LineInBin& line : bin.lines) {
      for (std::size_t i = 0; i < 2; ++i, ++column) {
        mean(column) = line.mean[i];
        slope(column) = line.slope[i];
      }
    }
  }

 private:
  [[nodiscard]] double span_s() const { return scales_.time_end_s - scales_.time_begin_s; }

  template <class Row>
  Eigen::Index put_polynomial(double time_s, Row& out) {
    legendre(scales_.place_at(time_s), level_.terms, values_.data());
    for (std::size_t i = 1; i < level_.terms; ++i) out(static_cast<Eigen::Index>(i) - 1) = values_[i];
    return static_cast<Eigen::Index>(level_.terms > 0 ? level_.terms - 1 : 0);
  }

  const LevelModel& level_;
  const Scales& scales_;
  std::vector<double> values_;
  std::vector<double> slopes_;
};

/// Returns the level's functions but for the constant, at every residual row of a cycle.
Eigen::ArrayXXd level_of(const CycleData& data, const LevelModel& level, const Scales& scales) {
  Eigen::ArrayXXd rows(static_cast<Eigen::Index>(data.residuals()),
                       static_cast<Eigen::Index>(level.columns_behind_constant()));
  if (rows.cols() == 0) return rows;  // an empty array has no rows to point to
  LevelRow functions(level, scales);
  Eigen::Index row = 0;
  for (const double time_s : data.time_s) functions.at(time_s, rows.row(row++));
  for (const auto* bins : {&data.bins_before, &data.bins_after}) {
    for (const StickBin& bin : *bins) {
      functions.over(bin, rows.row(row), rows.row(row + 1));
      row += 2;
    }
  }
  return rows;
}

}  // namespace

CycleRows rows_of(const CycleData& cycle) {
  const auto size = static_cast<Eigen::Index>(cycle.residuals());
  CycleRows rows{Eigen::ArrayXd(size), Eigen::ArrayXd(size), Eigen::ArrayXd(size), {}};
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < cycle.time_s.size(); ++i, ++row) {
    rows.force(row) = cycle.force[i];
    rows.weight(row) = cycle.weight.empty() ? 1.0 : cycle.weight[i];
  }
  rows.level_weight = rows.weight;
  for (const auto* bins : {&cycle.bins_before, &cycle.bins_after}) {
    for (const StickBin& bin : *bins) {
      rows.force.segment<2>(row) << bin.force, bin.slope;
      rows.weight.segment<2>(row) << std::sqrt(bin.count), std::sqrt(bin.time_spread);
      rows.level_weight.segment<2>(row) << std::sqrt(bin.count), 0.0;
      row += 2;
    }
  }
  return rows;
}

std::optional<CycleSet> CycleSet::create(std::vector<CycleData> cycles, std::vector<double> reference_s,
                                         LevelModel level, const Scales& scales) {
  if (cycles.size() < thresholds::kFewestSlips) return std::nullopt;
  return CycleSet(std::move(cycles), std::move(reference_s), std::move(level), scales);
}

CycleSet::CycleSet(std::vector<CycleData> cycles, std::vector<double> reference_s, LevelModel level,
                   const Scales& scales)
    : cycles_(std::move(cycles)),
      reference_s_(std::move(reference_s)),
      level_(std::move(level)),
      rows_(cycles_.size()),
      even_step_s_(cycles_.size()) {
  std::size_t samples = 0;
  for (const CycleData& cycle : cycles_) samples += cycle.time_s.size();
  for_cycles(cycles_.size(), samples, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      rows_[i] = rows_of(cycles_[i]);
      rows_[i].level = level_of(cycles_[i], level_, scales);
      even_step_s_[i] = even_step_of(cycles_[i].time_s, tolerated_rounding_s(scales));
    }
  });
}

CycleSet CycleSet::with_level(LevelModel level, const Scales& scales) const {
  return {cycles_, reference_s_, std::move(level), scales};
}

}  // namespace slipfit::fit
