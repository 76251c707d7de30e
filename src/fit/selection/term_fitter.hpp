#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// The fit on the cycles of another one, above its own level, its rise after the slips that it has there.
BlockFit carried_to(const std::shared_ptr<const CycleSet>& set, const BlockFit& from);

/// The fit with a time of the sensor as one parameter more.
BlockFit with_free_time(const BlockFit& fit, FreeTime time);

/// Returns by how much the AICc of `rich`, a fit with one parameter more, is lower than that of `poor` on the same
/// samples.
double gain_on_same_samples(const DampedFit& rich, const DampedFit& poor);

/// The terms that a fit may have besides those of every fit.
struct Terms {
  bool average = false;    ///< an average of the sensor, its time W a parameter (docs/model.md section 7)
  bool weakening = false;  ///< friction that weakens over a slip distance D_c, instead of Coulomb friction (section 9)
  bool rise = false;       ///< a rise of the force after slips (section 10), where the plain fit has none
};

/// A minimum whose AICc is higher by this much on some of the cycles is ruled out.
inline constexpr double kRuledOut = 2.0 * thresholds::kTierPrice;

/// The order of a low-pass filter and the delay with which its search starts.
struct FilterStart {
  std::size_t order = 1;
  double lag_s = 0.0;  ///< its delay (docs/model.md section 7)
};

/// A fit to some of the cycles where a search for it ended.
struct Minimum {
  BlockFit blocks;
  /// What the solver minimises: cycles far worse than the others count linearly in it (SolveOptions::robust). It says
  /// which of two searches found the better end; likelihoods follow from plain sums of squares.
  double minimised = 0.0;
};

/// The minima of a fit with more terms.
struct Minima {
  std::vector<Minimum> found{};  ///< the best one first; the next one where some of the cycles do not rule it out
  bool is_complete = true;       ///< false: the fit of more cycles failed from one of the starts
};

/// Fits with more terms to the cycles that a plain fit of the same recording has. Few cycles find the minima, more of
/// them compare the terms, and only what they do not rule out is fitted to all cycles.
class TermFitter {
 public:
  /// Cuts the cycles of `plain` wide enough for every term, and `beyond_s` wider. The result is empty where too few
  /// cycles are that wide. `input` and `plain` must outlive the fitter.
  static std::optional<TermFitter> create(const FitInput& input, const DampedFit& plain, double beyond_s = 0.0);

  /// Minima of the cycles that compare the terms. A minimum without a slip distance, without an average or without
  /// slips that come to rest is not among them, unless `is_asked`: by the user, whatever these cycles show.
  [[nodiscard]] Minima minima(Terms terms, bool is_asked = false) const;

  /// The plain fit of the cycles that compare the terms.
  [[nodiscard]] Minimum plain() const;
  /// The fit of these cycles with the terms of `fit`, another fit of the recording. Empty where a slip has no solution.
  [[nodiscard]] std::optional<Minimum> near(const BlockFit& fit) const;

  /// Fits Coulomb friction behind a low-pass filter whose delay is a parameter. The filter takes the place of an
  /// average that nobody stated. The search starts from the slips of `from` with each of `starts`; a few cycles find
  /// the best of them. Returns the minimum of the cycles that compare the terms, or nothing if no start leads to a
  /// solution.
  [[nodiscard]] std::optional<Minimum> behind_filter(const BlockFit& from, std::span<const FilterStart> starts) const;

  /// Twice the logarithm of the likelihood ratio of two fits of these cycles, each at its best noise. Above 0 where
  /// `better` explains them better.
  [[nodiscard]] double gain_on_some(const Minimum& better, const Minimum& other) const;
  /// The same of all cycles, if they show as much in proportion to their residuals.
  [[nodiscard]] double gain_on_all(const Minimum& better, const Minimum& other) const;

  /// A minimum as a fit that is not ruled out. Its covariance is scaled to that of all cycles.
  [[nodiscard]] DampedFit rival_of(const Minimum& minimum) const;

  /// The fit of all cycles with the terms of `near`, without the outliers of its own model, with its uncertainty but
  /// for what finish_fit adds. Empty where a slip has no solution.
  [[nodiscard]] std::optional<DampedFit> draft(const BlockFit& near) const;
  /// The same, finished. zeta is held at 0 where it came out below.
  [[nodiscard]] std::optional<DampedFit> fit(const BlockFit& near) const;

 private:
  TermFitter(const FitInput& input, const DampedFit& plain, double beyond_s);

  struct Start {
    double share_of_fall = 0.0;  ///< that the square of an average's time takes of the square of the fall's
    double weakening = 0.0;      ///< k D_c / (F_s - F_k)
    double length_m = 0.0;       ///< of a rise, where the plain fit has none
  };

  using Cycles = std::shared_ptr<const CycleSet>;

  [[nodiscard]] Cycles set_of(std::vector<CycleData> cycles) const;
  [[nodiscard]] std::vector<CycleData> cycles_without(const std::vector<std::size_t>& excluded,
                                                      double half_width_s) const;
  [[nodiscard]] std::vector<CycleData> some_of(const std::vector<CycleData>& cycles, std::size_t count) const;
  /// These cycles, their slips with no more samples than their shape needs.
  [[nodiscard]] Cycles thin_of(const CycleSet& cycles) const;
  /// The solution near another one, but for its rise: by few samples to the end of a valley, then by all of them.
  [[nodiscard]] std::optional<BlockFit> settled_on(const Cycles& cycles, const BlockFit& near, const Held& held) const;
  /// The blocks with these values, their cycles by the features of their slips.
  [[nodiscard]] BlockFit started(BlockFit blocks, const Coordinates& values) const;
  [[nodiscard]] Scales scales_of(Terms terms, double average_s) const;
  [[nodiscard]] std::vector<Start> starts_of(Terms terms) const;
  [[nodiscard]] double gain_on(const CycleSet& cycles, const Minimum& better, const Minimum& other) const;
  [[nodiscard]] std::vector<double> lengths_of_rise() const;
  /// The first steps of a fit of few cycles from this start. `rise_length`: of a rise that the plain fit has, over its
  /// length there. Empty where a slip has no solution; so are drafts.
  [[nodiscard]] std::optional<Minimum> begun(Terms terms, const Start& start, double rise_length) const;
  [[nodiscard]] std::optional<Minimum> drafted(Terms terms, Minimum begun) const;
  /// Returns the drafts, of starts that share an average only that of the best one after its first steps: the average
  /// is what separates minima.
  [[nodiscard]] std::vector<Minimum> drafts_of(Terms terms) const;
  [[nodiscard]] Minimum descended(Minimum draft) const;
  /// Solves near another fit, to the accuracy that comparing terms needs. Empty where a slip has no solution.
  [[nodiscard]] std::optional<Minimum> solved(const Cycles& cycles, const BlockFit& near) const;
  /// Returns whether the slips come to rest, and the average is shorter than a stick.
  [[nodiscard]] bool has_slips_of_its_own(const BlockFit& fit) const;
  [[nodiscard]] bool has_term(const BlockFit& fit) const;
  [[nodiscard]] BlockFit with_poorest_level(BlockFit wandering) const;
  [[nodiscard]] std::optional<DampedFit> without_outliers(const BlockFit& rough) const;
  [[nodiscard]] std::optional<DampedFit> without_damping(DampedFit fit) const;

  const FitInput& input_;
  const DampedFit& plain_;
  Held held_;
  double fall_s2_;  ///< square of the time by which slip and average together draw the fall out
  double half_width_s_;
  HumLines hum_;   ///< of the plain fit
  Cycles cycles_;  ///< of the plain fit, cut wider
  Cycles few_;     ///< that find minima, their slips with no more samples than their shape needs
  Cycles enough_;  ///< that compare terms; all where these are not much more work
};

}  // namespace slipfit::fit
