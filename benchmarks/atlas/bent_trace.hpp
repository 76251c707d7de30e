#pragma once

#include <vector>

#include "slipfit/model/motion.hpp"

namespace atlas {

/// What bends slips of Coulomb friction.
struct Bends {
  double average_s = 0.0;        ///< the sensor tells the mean force over so long, half before and half after
  double slip_distance_m = 0.0;  ///< over which static friction falls to kinetic friction
};

/// Spring force at even times, step by step (Runge-Kutta of fourth order) and averaged by the trapezoidal rule: shares
/// nothing with the closed forms. Begins at a stick without force.
class BentTrace {
 public:
  BentTrace(const slipfit::Slider& slider, const slipfit::Friction& friction, double speed_m_per_s, const Bends& bends)
      : slider_(slider), friction_(friction), speed_m_per_s_(speed_m_per_s), bends_(bends) {}

  /// At `begin_s` + i `step_s`, `count` of them.
  [[nodiscard]] std::vector<double> force_N(double begin_s, double step_s, std::size_t count) const;

 private:
  /// The force is a straight line from one to the next.
  struct Node {
    double time_s = 0.0, force_N = 0.0;
    double integral_Ns = 0.0;  ///< of the force up to here
  };
  /// While it slides: force of the spring, speed and distance since the onset.
  struct State {
    double force_N = 0.0, speed_m_per_s = 0.0, slipped_m = 0.0;
  };

  [[nodiscard]] std::vector<Node> nodes_until(double end_s) const;
  void slide(std::vector<Node>& nodes) const;
  [[nodiscard]] State slope(const State& at) const;
  [[nodiscard]] State stepped(const State& from, double step_s) const;
  static void add(std::vector<Node>& nodes, double time_s, double force_N);
  static Node between(const std::vector<Node>& nodes, double time_s);

  slipfit::Slider slider_;
  slipfit::Friction friction_;
  double speed_m_per_s_;
  Bends bends_;
};

}  // namespace atlas
