#pragma once

#include <array>
#include <string_view>

#include "io/names.hpp"

// The words and units by which testers name their columns (English and German mostly), in lower case.

namespace slipfit::reading {

struct KnownUnit {
  std::string_view text;
  UnitClass unit_class;
};

constexpr std::array kUnits = std::to_array<KnownUnit>({
    {"s", UnitClass::Time},
    {"sec", UnitClass::Time},
    {"secs", UnitClass::Time},
    {"sek", UnitClass::Time},
    {"seconds", UnitClass::Time},
    {"second", UnitClass::Time},
    {"ms", UnitClass::Time},
    {"msec", UnitClass::Time},
    {"us", UnitClass::Time},
    {"usec", UnitClass::Time},
    {"ns", UnitClass::Time},
    {"min", UnitClass::Time},
    {"mins", UnitClass::Time},
    {"minutes", UnitClass::Time},
    {"h", UnitClass::Time},
    {"hr", UnitClass::Time},
    {"m", UnitClass::Length},
    {"mm", UnitClass::Length},
    {"cm", UnitClass::Length},
    {"um", UnitClass::Length},
    {"nm", UnitClass::Length},
    {"micron", UnitClass::Length},
    {"microns", UnitClass::Length},
    {"inch", UnitClass::Length},
    {"N", UnitClass::Force},
    {"mN", UnitClass::Force},
    {"uN", UnitClass::Force},
    {"kN", UnitClass::Force},
    {"cN", UnitClass::Force},
    {"MN", UnitClass::Force},
    {"gf", UnitClass::Force},
    {"kgf", UnitClass::Force},
    {"lbf", UnitClass::Force},
    {"kp", UnitClass::Force},
    {"newton", UnitClass::Force},
    {"newtons", UnitClass::Force},
    {"dyn", UnitClass::Force},
    {"g", UnitClass::Mass},
    {"kg", UnitClass::Mass},
    {"mg", UnitClass::Mass},
    {"lb", UnitClass::Mass},
    {"lbs", UnitClass::Mass},
    {"1", UnitClass::One},
    {"-", UnitClass::One},
    {"%", UnitClass::One},
    {"Nm", UnitClass::Other},
    {"Nmm", UnitClass::Other},
    {"mNm", UnitClass::Other},
    {"N m", UnitClass::Other},
    {"N mm", UnitClass::Other},
    {"N*mm", UnitClass::Other},
    {"N.m", UnitClass::Other},
    {"J", UnitClass::Other},
    {"mJ", UnitClass::Other},
    {"W", UnitClass::Other},
    {"Pa", UnitClass::Other},
    {"kPa", UnitClass::Other},
    {"MPa", UnitClass::Other},
    {"GPa", UnitClass::Other},
    {"bar", UnitClass::Other},
    {"V", UnitClass::Other},
    {"mV", UnitClass::Other},
    {"A", UnitClass::Other},
    {"mA", UnitClass::Other},
    {"\xC2\xB0\x43", UnitClass::Other},
    {"C", UnitClass::Other},
    {"degC", UnitClass::Other},
    {"K", UnitClass::Other},
    {"Hz", UnitClass::Other},
    {"kHz", UnitClass::Other},
    {"rpm", UnitClass::Other},
    {"1/min", UnitClass::Other},
    {"1/s", UnitClass::Other},
    {"m/s", UnitClass::Other},
    {"mm/s", UnitClass::Other},
    {"um/s", UnitClass::Other},
    {"mm/min", UnitClass::Other},
    {"m/min", UnitClass::Other},
    {"deg", UnitClass::Other},
    {"\xC2\xB0", UnitClass::Other},
    {"rad", UnitClass::Other},
    {"N/mm", UnitClass::Other},
    {"m/s2", UnitClass::Other},
    {"m/s^2", UnitClass::Other},
    {"mm/s2", UnitClass::Other},
    {"counts", UnitClass::Other},
    {"a.u.", UnitClass::Other},
    {"Nm/s", UnitClass::Other},
});

constexpr auto kTime = std::to_array<std::string_view>({"time",
                                                        "zeit",
                                                        "timestamp",
                                                        "timestamps",
                                                        "elapsed",
                                                        "t",
                                                        "tid",
                                                        "temps",
                                                        "tiempo",
                                                        "testzeit",
                                                        "messzeit",
                                                        "laufzeit",
                                                        "pr\xC3\xBC"
                                                        "fzeit",
                                                        "pruefzeit",
                                                        "millis",
                                                        "micros",
                                                        "zeitstempel",
                                                        "versuchszeit",
                                                        "uhrzeit",
                                                        "clock",
                                                        "seconds",
                                                        "sec",
                                                        "secs",
                                                        "msec"});
constexpr auto kOtherQuantity = std::to_array<std::string_view>(
    {"stress",       "spannung", "pressure",        "druck",      "work",     "arbeit",      "energy",
     "energie",      "temp",     "temperature",     "temperatur", "torque",   "moment",      "drehmoment",
     "velocity",     "speed",    "geschwindigkeit", "rpm",        "humidity", "feuchte",     "voltage",
     "acceleration", "accel",    "beschleunigung",  "power",      "wear",     "verschleiss", "verschlei\xC3\x9F",
     "radius",       "angle",    "winkel",          "frequency",  "frequenz", "stiffness",   "mass",
     "thickness",    "vibration"});
constexpr auto kCounter = std::to_array<std::string_view>(
    {"cycle", "cycles", "zyklus", "zyklen", "index", "idx",    "sample", "samples", "step",    "no",
     "nr",    "number", "lap",    "laps",   "turns", "status", "marker", "event",   "counter", "id"});
constexpr auto kDisplacement = std::to_array<std::string_view>(
    {"displacement", "displ",      "disp",     "strain",       "position",  "pos",        "weg",          "standardweg",
     "stroke",       "travel",     "distance", "dist",         "extension", "dehnung",    "verschiebung", "hub",
     "path",         "auslenkung", "traverse", "traversenweg", "crosshead", "elongation", "deflection"});
constexpr auto kForce =
    std::to_array<std::string_view>({"force", "forces", "kraft", "standardkraft", "fuerza", "forza", "effort", "f"});
constexpr auto kLoad = std::to_array<std::string_view>({"load", "last", "loadcell", "weight"});
constexpr auto kNominal = std::to_array<std::string_view>({"applied", "nominal"});
constexpr auto kNormal =
    std::to_array<std::string_view>({"fn", "fz", "normal", "normalkraft", "normallast", "normalforce", "vertical",
                                     "downforce", "auflast", "preload", "vorlast"});
constexpr auto kCoefficient = std::to_array<std::string_view>(
    {"cof", "mu", "\xC2\xB5", "\xCE\xBC", "mue", "reibwert", "reibzahl", "reibungszahl", "reibungskoeffizient",
     "reibkoeffizient", "reibbeiwert", "coefficient", "coeff", "koeffizient"});
constexpr auto kFriction = std::to_array<std::string_view>({"friction", "frictional", "reibung", "frict"});
constexpr auto kTangential = std::to_array<std::string_view>({"ft",
                                                              "fx",
                                                              "fy",
                                                              "ff",
                                                              "fr",
                                                              "ffric",
                                                              "ftan",
                                                              "tangential",
                                                              "lateral",
                                                              "shear",
                                                              "traction",
                                                              "drag",
                                                              "reibkraft",
                                                              "reibungskraft",
                                                              "tangentialkraft",
                                                              "querkraft",
                                                              "zugkraft",
                                                              "scherkraft",
                                                              "horizontal",
                                                              "pull",
                                                              "pulling",
                                                              "frictionforce",
                                                              "tangentialforce"});

}  // namespace slipfit::reading
