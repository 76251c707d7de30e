#pragma once

#include <string>
#include <string_view>

namespace slipfit::reading {

/// The contents of a column according to its name and unit.
enum class Role {
  Unknown,
  Time,
  TangentialForce,
  NormalForce,
  FrictionCoefficient,
  Displacement,
  Speed,
  Step,
  Torque,
  Other
};

/// The quantity that a unit measures, as far as columns are distinguished by it.
enum class UnitClass { None, NotAUnit, Time, Length, Force, Mass, Speed, Rotation, One, Torque, Other };

struct ColumnName {
  std::string text;  ///< as in the file, in UTF-8; empty where the file has none
  std::string base;  ///< without the unit
  std::string unit;  ///< "mN" of "force [mN]", "Ft (mN)", "force_mN", or from a units row; may be empty
  Role role = Role::Unknown;
  int rank = 0;  ///< how strongly the name says so: 4 "Ft", 3 "Fx", 2 "force", 1 "load" or only the unit
};

/// Returns true if a word of the name means a load ("Load", "Last"): next to a friction force this is the normal force.
bool is_load(const ColumnName& name);

UnitClass classify_unit(std::string_view unit);

/// Reads the name of a column from the cells of the name row and the unit row (either may be empty).
ColumnName read_name(std::string_view name_cell, std::string_view unit_cell);

}  // namespace slipfit::reading
