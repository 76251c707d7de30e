#pragma once

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

}  // namespace slipfit::reading
