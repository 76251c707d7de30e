#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "chart/chart.hpp"

// What all studies of the atlas share: effort, timing, fronts, files.

namespace atlas {

namespace chart = slipfit::chart;

enum class Effort { Quick, Full };

struct File {
  std::string name;
  std::string content;
};

/// How one method is drawn in every chart of a study.
struct Look {
  std::string name;
  chart::Colour colour = chart::Colour::Black;
  chart::Shape shape = chart::Shape::Dot;
  chart::Stroke stroke = chart::Stroke::Solid;
};

/// CPU seconds of this thread: other work on the machine disturbs them less than the clock on the wall.
double cpu_now_s();

/// CPU seconds of one call: median of `repeats` batches, each long enough for the clock.
double time_call_s(const std::function<void()>& call, std::size_t repeats);

/// Empty: not finite.
double median_of(std::vector<double> values);

/// Spread that 68 % of normal errors would have: 1.4826 times the median size. Wild errors do not move it.
double robust_size(std::vector<double> errors);

/// The points that no other point beats in both x and y, by x.
std::vector<chart::Point> front_of(std::vector<chart::Point> points);

/// The front as the staircase of the least y that can be had for an x.
chart::Line draw_front(const std::vector<chart::Point>& points, double right_end);

/// Even steps of the logarithm, both ends included.
std::vector<double> log_spaced(double low, double high, std::size_t count);

/// Marks at, and a line through, the points of one method.
void add_series(chart::Panel& panel, const Look& look, const std::vector<chart::Point>& points);

/// The same series as in the panel above: no second legend.
void strip_legend(chart::Panel& panel);

/// "" for what is not finite.
std::string cell(double value);

std::vector<File> study_forward(Effort effort);
std::vector<File> study_frequency(Effort effort);
std::vector<File> study_fits(Effort effort);
std::vector<File> map_failures(Effort effort);
/// Of fits, where an average of the sensor or friction that weakens bends the slips.
std::vector<File> map_term_failures(Effort effort);

}  // namespace atlas
