// Text as a quantity or a unit of every dimension.
#include <cmath>
#include <string_view>

#include "demand.hpp"
#include "slipfit/core/units.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using slipfit::Dimension;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Dimension dimension : {Dimension::Time, Dimension::Length, Dimension::Speed, Dimension::Force,
                                    Dimension::Frequency, Dimension::AngularSpeed, Dimension::Dimensionless}) {
    if (const auto unit = slipfit::parse_unit(text, dimension)) {
      fuzz::demand(std::isfinite(unit.value()) && unit.value() > 0.0, "a scale is a number > 0");
    } else {
      fuzz::demand_readable(unit.error());
    }
    if (const auto quantity = slipfit::parse_quantity(text, dimension)) {
      fuzz::demand(std::isfinite(quantity.value()), "a quantity is a finite number");
    } else {
      fuzz::demand_readable(quantity.error());
    }
  }
  return 0;
}
