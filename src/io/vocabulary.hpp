#pragma once

#include <array>
#include <string_view>

// The words by which testers name their columns (English and German mostly), in lower case.

namespace slipfit::reading {

constexpr auto kWordsNotUnits =
    std::to_array<std::string_view>({"in", "In", "IN", "Min", "MIN", "mil", "foot", "feet", "day", "days", "turn",
                                     "turns", "rev", "count", "digit", "arb"});
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
