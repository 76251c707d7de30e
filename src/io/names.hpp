#pragma once

#include <string>
#include <string_view>

// The words by which testers name their columns (English, German, French, Spanish and Italian), in lower case, parted
// by blanks.

namespace slipfit::reading {

constexpr std::string_view kWordsNotUnits = "in In IN Min MIN mil foot feet day days turn turns rev count digit arb";
/// Words in brackets after a name that are not units: "Force (left)", "Time (UTC)".
constexpr std::string_view kRemarks =
    "left right top bottom front rear upper lower links rechts oben unten gauche droite axial radial channel ch kanal "
    "sensor cell transducer measured calculated calc calibrated corrected absolute abs relative rel mean avg average "
    "mittel mittelwert filtered filt smoothed smooth gefiltert gemessen korrigiert peak max local utc gmt absolut "
    "total gesamt tared static dynamic kinetic analog";
constexpr std::string_view kTime =
    "time zeit timestamp timestamps elapsed t tid temps tiempo tempo testzeit messzeit laufzeit prüfzeit pruefzeit "
    "millis "
    "micros zeitstempel versuchszeit uhrzeit clock seconds sec secs msec";
constexpr std::string_view kOtherQuantity =
    "stress spannung pressure druck work arbeit energy energie temp temperature temperatur "
    "humidity feuchte voltage acceleration accel beschleunigung power wear "
    "verschleiss verschleiß radius angle winkel frequency frequenz stiffness mass thickness vibration";
constexpr std::string_view kTorque = "torque moment drehmoment reibmoment reibungsmoment couple coppia";
constexpr std::string_view kVelocity =
    "velocity speed geschwindigkeit rpm drehzahl v vitesse velocidad velocità gleitgeschwindigkeit";
constexpr std::string_view kStep = "step schritt segment stage phase abschnitt testschritt recipestep stepno";
constexpr std::string_view kCounter =
    "cycle cycles zyklus zyklen index idx sample samples no nr number lap laps turns status marker event counter id";
constexpr std::string_view kDisplacement =
    "displacement displ disp strain position pos weg standardweg stroke travel distance dist extension dehnung "
    "verschiebung hub path auslenkung traverse traversenweg crosshead elongation deflection déplacement deplacement "
    "desplazamiento spostamento";
constexpr std::string_view kForce = "force forces kraft standardkraft fuerza forza effort f";
constexpr std::string_view kLoad = "load last loadcell weight charge carga carico";
constexpr std::string_view kNominal = "applied nominal set soll target setpoint";
constexpr std::string_view kNormal =
    "fn fz normal normale normalkraft normallast normalforce vertical downforce auflast preload vorlast";
constexpr std::string_view kCoefficient =
    "cof mu µ μ mue reibwert reibzahl reibungszahl reibungskoeffizient reibkoeffizient reibbeiwert coefficient coeff "
    "koeffizient";
constexpr std::string_view kFriction =
    "friction frictional reibung frict frottement fricción friccion rozamiento attrito";
constexpr std::string_view kTangential =
    "ft ff fr ffric ftan tangential shear traction drag reibkraft reibungskraft tangentialkraft zugkraft scherkraft "
    "pull pulling frictionforce tangentialforce tangentielle tangencial tangenziale";
constexpr std::string_view kLateral = "fx fy lateral querkraft horizontal";  // one of them may be the tangential force

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
