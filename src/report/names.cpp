#include "report/names.hpp"

namespace slipfit {

std::string_view name_of(Tier tier) {
  switch (tier) {
    case Tier::Sawtooth:
      return "sawtooth";
    case Tier::Undamped:
      return "undamped";
    case Tier::Damped:
      return "damped";
    case Tier::Velocity:
      return "velocity";
  }
  return "unknown";
}

std::string_view name_of(ForceView view) {
  switch (view) {
    case ForceView::Spring:
      return "spring";
    case ForceView::Transmitted:
      return "transmitted";
    case ForceView::Contact:
      return "contact";
  }
  return "unknown";
}

std::string_view name_of(ForceQuantity quantity) {
  return quantity == ForceQuantity::Force_N ? "force" : "friction_coefficient";
}

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::StickSlip:
      return "stick_slip";
    case Verdict::SteadySliding:
      return "steady_sliding";
    case Verdict::OscillatorySlip:
      return "oscillatory_slip";
    case Verdict::Undetermined:
      return "undetermined";
  }
  return "undetermined";
}

std::string_view name_of(ParameterStatus status) {
  switch (status) {
    case ParameterStatus::Identified:
      return "identified";
    case ParameterStatus::Weak:
      return "weak";
    case ParameterStatus::Bounded:
      return "bounded";
    case ParameterStatus::Unidentified:
      return "unidentified";
    case ParameterStatus::Conditional:
      return "conditional";
    case ParameterStatus::Fixed:
      return "fixed";
  }
  return "unidentified";
}

std::string_view name_of(SweepRole role) {
  switch (role) {
    case SweepRole::Cycles:
      return "cycles";
    case SweepRole::Steady:
      return "steady";
    case SweepRole::LeftOut:
      return "left_out";
  }
  return "left_out";
}

std::string_view name_of(Regularity regularity) {
  switch (regularity) {
    case Regularity::Regular:
      return "regular";
    case Regularity::Irregular:
      return "irregular";
    case Regularity::Clocked:
      return "clocked";
  }
  return "";
}

}  // namespace slipfit
