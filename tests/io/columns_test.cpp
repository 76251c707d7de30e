#include "temp_file.hpp"

using namespace io_test;
using slipfit::ForceQuantity;

namespace {

/// Rows under the names: column c of row r is r + 10 c for the first (the clock), and a varying number for the others.
std::string table(const std::string& names, const std::string& delimiter = ",") {
  std::string text = names + "\n";
  std::size_t columns = 1;
  for (auto at = names.find(delimiter); at != std::string::npos; at = names.find(delimiter, at + 1)) ++columns;
  for (std::size_t r = 0; r < 8; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double value =
          c == 0 ? 0.1 * static_cast<double>(r) : static_cast<double>(c) + 0.01 * static_cast<double>((r * r) % 7);
      text += (c == 0 ? "" : delimiter) + std::to_string(value);
    }
    text += "\n";
  }
  return text;
}

/// 1-based number of the column that was taken for the force, as its numbers tell.
int force_column(const slipfit::Recording& recording) {
  return static_cast<int>(recording.force()[0]) + 1;
}

}  // namespace

TEST_CASE("the tangential force is found by its name") {
  struct Case {
    std::string names;
    int column;
  };
  const Case cases[] = {
      {"time,displacement,force", 3},
      {"Time(s),Fx (N),Fz (N)", 2},
      {"Time(s),Fz (N),Fx (N)", 3},
      {"t,Fn,Ft", 3},
      {"t,Ft,Fn", 2},
      {"Zeit,Weg,Normalkraft,Reibkraft", 4},
      {"Zeit [s],Standardweg [mm],Standardkraft [N]", 3},
      {"Test time,Load,Friction force", 3},
      {"Time,Normal load,Friction force,COF", 3},
      {"Time,COF,Friction force", 3},
      {"elapsed,load,position", 2},
      {"Elapsed Time,Stroke,Load Cell (N)", 3},
      {"Time,TangentialForce,NormalForce", 2},
      {"Time,Velocity,Torque [Nmm],Lateral force", 4},
      {"Time,Friction [mN],Humidity [%]", 2},
      {"Time [s],Channel 1 [N],Channel 2 [V]", 2},
      {"t / s,x / mm,F / N", 3},
      {"Time, Strain,Standard force,Work", 3},
      {"time,F_n,F_t", 3},
      {"time,Force Z,Force X", 3},
      {"time,X-Force [N],Z-Force [N]", 2},
      {"time,signal", 2},
      {"time,Temperature [\xC2\xB0\x43],signal", 3},
      {"time,normal_force_N,lateral_force_mN", 3},
  };
  for (const Case& c : cases) {
    CAPTURE(c.names);
    slipfit::ReadOptions options;
    options.force_unit = "N";  // the numbers then tell the column
    const auto recording = read_ok(table(c.names), options);
    CHECK(force_column(recording) == c.column);
    CHECK(recording.conditions().quantity == ForceQuantity::Force_N);
  }
}

TEST_CASE("a unit of several parts follows its name behind underscores") {
  slipfit::ReadOptions options;
  options.force_unit = "N";
  std::string text = "time_s,force_N,speed_mm_per_min\n";
  for (int r = 0; r < 8; ++r) text += std::to_string(0.1 * r) + "," + std::to_string((r * r) % 7) + ",600\n";
  CHECK(read_ok(text, options, {}).conditions().speed_m_per_s == Approx(0.01));
  const auto force = read_ok(table("time_s,signal,mean_force_per_contact_mN"));
  CHECK(force.force()[0] == Approx(2e-3));
}

TEST_CASE("a friction coefficient with a normal force is a force") {
  for (const std::string names :
       {"time,load [N],COF", "t,Fz,mu", "Zeit,Auflast,Reibwert", "time,Fn,Coefficient of friction ()"}) {
    CAPTURE(names);
    const auto recording = read_ok(table(names));
    CHECK(recording.conditions().quantity == ForceQuantity::Force_N);
    CHECK(recording.force()[0] == Approx(1.0 * 2.0));
    CHECK(recording.conditions().normal_force_N == Approx(1.01));  // the lower median
    CHECK(says(recording, {"Force is the friction coefficient times column 2"}));
  }
}

TEST_CASE("a friction coefficient is read if there is no tangential force") {
  for (const std::string names : {"Time(s),Displ(microns),Friction,Effective_Normal_stress(MPa)", "t,x [mm],\xC2\xB5",
                                  "t,x [mm],\xB5 [-]", "time,laps,Friction coefficient", "time,speed,signal [1]"}) {
    CAPTURE(names);
    const auto recording = read_ok(table(names));
    CHECK(recording.conditions().quantity == ForceQuantity::FrictionCoefficient);
    CHECK(force_column(recording) == 3);
    CHECK(says(recording, {"Friction coefficient is column 3"}));
  }
}

TEST_CASE("with the normal force a coefficient becomes a force, and that is said") {
  auto conditions = at_speed(1e-3);
  conditions.normal_force_N = 5.0;
  const std::string content = "time,COF [%]\n0,10\n1,20\n2,15\n";
  const auto recording = read_ok(content, {}, conditions);
  CHECK(recording.conditions().quantity == ForceQuantity::Force_N);
  CHECK(recording.force()[1] == Approx(1.0).epsilon(1e-15));
  CHECK(says(recording, {"friction coefficient times the normal force of 5 N"}));
  CHECK(read_ok(content).force()[1] == Approx(0.2).epsilon(1e-15));
}

TEST_CASE("the zero force is subtracted from a force, and refused with a warning from a bare coefficient") {
  auto conditions = at_speed(1e-3);
  conditions.zero_force_N = 0.5;
  CHECK(read_ok("time,force\n0,1\n1,2\n2,1\n", {}, conditions).force()[1] == 1.5);
  const auto coefficient = read_ok("time,COF\n0,0.1\n1,0.2\n2,0.1\n", {}, conditions);
  CHECK(coefficient.force()[1] == 0.2);
  CHECK(warns(coefficient, "zero_force_ignored"));
}

TEST_CASE("columns are chosen by name, by name without unit, or by number") {
  const std::string content = table("clock a,clock b,Fx [N],Fy [N]");
  for (const std::string name : {"Fy [N]", "fy", "4"}) {
    slipfit::ReadOptions options;
    options.time_column = "1";
    options.force_column = name;
    CHECK(force_column(read_ok(content, options)) == 4);
  }
}

TEST_CASE("without names the clock is the column that rises evenly, and only one other column may vary") {
  const auto recording = read_ok("5,0.0,1\n5,0.1,3\n5,0.2,2\n5,0.3,4\n");
  CHECK(copy(recording.force()) == std::vector<double>{1, 3, 2, 4});
  CHECK(recording.time_s()[3] == 0.3);
  CHECK(says(recording, {"The columns have no names"}));
  const auto error = read_error("0.0,1,7\n0.1,3,2\n0.2,2,9\n0.3,4,1\n");
  CHECK(error.code == "ambiguous_force_column");
}

TEST_CASE("integers that count by one are read as seconds, with the advice to state a sampling rate") {
  const std::string content = "0,1.5\n1,3.5\n2,2.5\n3,4.5\n";
  CHECK(says(read_ok(content), {"assumed to be in s", "--sample-rate"}));
  slipfit::ReadOptions options;
  options.sample_rate_Hz = 100.0;
  const auto recording = read_ok(content, options);
  CHECK(recording.time_s()[3] == 0.03);
  CHECK(recording.force()[3] == 4.5);
}

TEST_CASE("what cannot be chosen safely is an error that lists the columns and the option") {
  struct Case {
    std::string content;
    std::string code;
    std::string part;
  };
  const Case cases[] = {
      {table("time,ch1,ch2,ch3"), "ambiguous_force_column", "--force-column"},
      {table("time,displacement,Fn"), "no_force_column", "3 'Fn'"},
      {"force,displacement\n1,1\n3,2\n2,3\n4,4\n", "no_time_column", "--sample-rate"},
      {"1.5\n2.5\n1.7\n2.2\n", "no_time_column", "--sample-rate"},
      {"time,elapsed,force\n0,0,1\n1,1,2\n2,2,1\n3,3,2\n", "ambiguous_time_column", "--time-column"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.content);
    const auto error = read_error(c.content);
    CHECK(error.code == c.code);
    CHECK(contains(error.message, c.part));
  }
}
