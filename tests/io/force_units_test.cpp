// Units of the force column: those that are known, those that are not, and torques.
#include <string>
#include <vector>

#include "io/names.hpp"
#include "temp_file.hpp"

using namespace io_test;

namespace {

constexpr double kPound_N = 0.45359237 * 9.80665;

/// One force of 1 in a column of this name, in newtons.
double force_of_one(const std::string& name, const slipfit::ReadOptions& options = {}) {
  return read_ok("time (s);" + name + "\n0;1\n1;2\n2;1\n", options).force()[0];
}

slipfit::ReadOptions with_radius(double radius_m) {
  slipfit::ReadOptions options;
  options.radius_m = radius_m;
  return options;
}

}  // namespace

TEST_CASE("common units of force are read in brackets, behind a slash and in a row of units") {
  struct Known {
    std::string unit;
    double N;
  };
  const std::vector<Known> known = {{"kip", 1e3 * kPound_N},
                                    {"klbf", 1e3 * kPound_N},
                                    {"tf", 9806.65},
                                    {"kg f", 9.80665},
                                    {"kg-f", 9.80665},
                                    {"kg_f", 9.80665},
                                    {"KGF", 9.80665},
                                    {"lb-f", kPound_N},
                                    {"lb f", kPound_N},
                                    {"g-force", 9.80665e-3},
                                    {"gram force", 9.80665e-3},
                                    {"kilogram-force", 9.80665},
                                    {"pound-force", kPound_N},
                                    {"oz-f", kPound_N / 16.0},
                                    {"mgf", 9.80665e-6},
                                    {"pdl", 0.45359237 * 0.3048}};
  for (const Known& unit : known) {
    CAPTURE(unit.unit);
    CHECK(force_of_one("force [" + unit.unit + "]") == Approx(unit.N).epsilon(1e-12));
    CHECK(force_of_one("Force (" + unit.unit + ")") == Approx(unit.N).epsilon(1e-12));
    CHECK(read_ok("time;force\ns;" + unit.unit + "\n0;1\n1;2\n2;1\n").force()[0] == Approx(unit.N).epsilon(1e-12));
  }
  CHECK(force_of_one("F/kip") == Approx(1e3 * kPound_N).epsilon(1e-12));
}

TEST_CASE("text in the place of a unit that is none is refused, with both options that help") {
  for (const std::string unit : {"raw", "N*10", "x10", "blah", "tonf", "ADC raw"}) {
    for (const std::string& content :
         {"time (s);force [" + unit + "]\n0;1\n1;2\n2;1\n", "time (s);Force (" + unit + ")\n0;1\n1;2\n2;1\n",
          "time;force\ns;" + unit + "\n0;1\n1;2\n2;1\n"}) {
      CAPTURE(content);
      const auto error = read_error(content);
      CHECK(error.code == "unknown_unit");
      CHECK(contains(error.message, "'" + unit + "' is not a unit of force"));
      CHECK(contains(error.message, "--force-unit N"));
      CHECK(contains(error.message, "--force-scale '5 N/" + unit + "'"));
    }
  }
  CHECK(read_error("time (s);F/raw\n0;1\n1;2\n2;1\n").code == "unknown_unit");
  slipfit::ReadOptions options;
  options.force_scale = "0.5 N/raw";
  CHECK(force_of_one("Force (raw)", options) == 0.5);
  options.force_scale.reset();
  options.force_unit = "mN";
  CHECK(force_of_one("Force (raw)", options) == 1e-3);
}

TEST_CASE("a remark in brackets is not a unit") {
  for (const std::string name :
       {"Force (left)", "Force (Channel 2)", "Force (filtered)", "Force (load cell)", "Force (2)", "Force (Dev1/ai0)",
        "Ft/Fn", "Force (measured at the left arm)", "Zeit (UTC)", "Force_Min", "Force MIN", "zoom in", "Sensor u"}) {
    CAPTURE(name);
    CHECK(slipfit::reading::read_name(name, "").unit.empty());
  }
  CHECK(slipfit::reading::read_name("Kraft (KN)", "").unit == "KN");
  CHECK(slipfit::reading::read_name("Weg_MM", "").unit == "MM");
}

TEST_CASE("a torque over the radius is the force") {
  struct Torque {
    std::string name;
    double N_m;
  };
  const std::vector<Torque> torques = {{"Torque (N m)", 1.0},
                                       {"Torque [Nm]", 1.0},
                                       {"Drehmoment [mN m]", 1e-3},
                                       {"M (Nmm)", 1e-3},
                                       {"Torque [in lbf]", kPound_N * 0.0254},
                                       {"Torque in lbf", kPound_N * 0.0254},
                                       {"Torque (in-lb)", kPound_N * 0.0254},
                                       {"Torque (lb-in)", kPound_N * 0.0254},
                                       {"Torque [ft lbf]", kPound_N * 0.3048},
                                       {"Couple (N.m)", 1.0},
                                       {"torque", 1.0}};
  for (const Torque& torque : torques) {
    CAPTURE(torque.name);
    CHECK(force_of_one(torque.name, with_radius(0.02)) == Approx(torque.N_m / 0.02).epsilon(1e-12));
    const auto error = read_error("time (s);" + torque.name + "\n0;1\n1;2\n2;1\n");
    CHECK(error.code == "no_radius");
    CHECK(contains(error.message, "is a torque; give the distance of the contact from the axis with --radius"));
  }
  slipfit::ReadOptions stated = with_radius(0.02);
  stated.force_unit = "mN m";
  CHECK(force_of_one("M", stated) == Approx(0.05).epsilon(1e-12));
  CHECK(says(read_ok("time (s);Torque (Nmm)\n0;1\n1;2\n2;1\n", with_radius(0.02)), {"torque", "0.02 m"}));
}

TEST_CASE("a force is preferred to a torque, and an energy is not a force") {
  CHECK(copy(read_ok("time (s);Torque (N m);Ft (N)\n0;1;5\n1;2;6\n2;1;5\n").force()) ==
        std::vector<double>{5.0, 6.0, 5.0});
  CHECK(read_error("time (s);Arbeit (J)\n0;1\n1;2\n2;1\n").code == "no_force_column");
}

TEST_CASE("names of forces in French, Spanish and Italian") {
  for (const std::string names :
       {"Temps (s);Force normale (N);Force tangentielle (N)", "Temps (s);Force normale (N);Force (N)",
        "Temps (s);Force normale (N);Force de frottement (N)", "Tiempo (s);Fuerza normal (N);Fuerza de rozamiento (N)",
        "Tempo (s);Forza normale (N);Forza di attrito (N)"}) {
    CAPTURE(names);
    const auto recording = read_ok(names + "\n0;10;1\n1;10;2\n2;10;1\n");
    CHECK(copy(recording.force()) == std::vector<double>{1.0, 2.0, 1.0});
    CHECK(recording.conditions().normal_force_N == 10.0);
  }
}
