// What a warning means, in German, by its code (docs/formats.md#warnings). Its own sentence, with the numbers, stays English.
const kGermanWarnings = {
  origin_not_known: "Ein Muster allein sagt nicht, ob es vom Stick-Slip oder von der Bearbeitung stammt.",
  rsm_differs: "RSm und Abstand weichen um mehr als ein Fünftel voneinander ab.",
  spacing_drifts: "Der Abstand ändert sich entlang der Spur.",
  holes_bridged: "Einige Punkte des Profils wurden nicht gemessen.",
  rows_without_number: "Zeilen ohne Zahl für Zeit oder Kraft wurden ausgelassen.",
  time_runs_backwards: "Zeilen, deren Zeit vor einer früheren liegt, wurden ausgelassen.",
  repeated_time_stamps: "Einige Zeilen tragen die Zeit der vorigen; sie wurden behalten.",
  speed_differs_from_displacement: "Die Wegspalte bewegt sich mit einer anderen Geschwindigkeit als der angegebenen.",
  sample_rate_differs: "Die Zeiten der Datei haben eine andere Abtastrate als die angegebene; die Angabe gilt.",
  level_repeats: "Das Kraftniveau wiederholt sich entlang des Weges.",
  level_trend: "Das Kraftniveau steigt oder fällt: Drift des Sensors oder geänderte Reibung (--drift sagt, was davon).",
  values_contradict: "Zwei Angaben zu derselben Größe widersprechen sich; die Bereiche enthalten beide, oder eine von mehreren Aufzeichnungen weicht ab.",
  speed_differs: "Die Geschwindigkeitsspalte sagt etwas anderes als die Angabe; die Angabe gilt.",
  normal_force_differs: "Die Spalte der Normalkraft sagt etwas anderes als die Angabe; die Angabe gilt.",
  normal_force_varies: "Die Normalkraft schwankt um mehr als ein Zehntel; ihr Median steht für sie.",
  implausible_units: "Die Werte sind unwahrscheinlich groß oder klein: vermutlich ist eine Einheit um 1000 falsch.",
  part_of_recording: "Weniger als 80 % der Aufzeichnung gleitet; nur dieser Abschnitt wurde ausgewertet.",
  several_steps: "Die Datei enthält mehrere Aufzeichnungen nacheinander; eine davon wurde genommen.",
  strokes_pooled: "Ein Versuch mit Hin- und Rückweg: alle Hübe wurden zusammen ausgewertet.",
  drive_measured: "Die Kraft wurde über dem gemessenen Weg des Antriebs ausgewertet, nicht über der angegebenen Geschwindigkeit.",
  drive_moves_in_slips: "Der Antrieb holt während des Gleitens auf: Eigenfrequenz, Masse, Dämpfung und F_s - F_k sind Näherungen.",
  container_cut: "Der letzte Block der TDMS-Datei ist unvollständig und wurde ausgelassen.",
  zero_force_ignored: "Ein Nullpunkt in Newton lässt sich von einer Reibungszahl nicht abziehen.",
  gaps: "Die Aufzeichnung hat zeitliche Lücken.",
  uneven_clock: "Der Zeitschritt schwankt um mehr als 2 %.",
  clipped: "Der Sensor ist übersteuert; diese Messwerte bleiben aus der Anpassung heraus.",
  impulses: "Einzelne Messwerte liegen weit von ihren Nachbarn; sie bleiben aus der Anpassung heraus.",
  quantised: "Die Kräfte sind Vielfache einer Stufe, die gröber ist als das Rauschen.",
  suspicious_line: "Eine Linie des Spektrums stammt nicht von den Rutschern (Netz, Einstreuung, Antrieb, Eigenschwingung).",
  changes_on_the_way: "Abstand oder Kraftabfall der Rutscher ändern sich im Verlauf; eine Zahl für beides ist ein Mittel.",
  broken_rhythm: "Einige Abstände passen nicht zum Takt der Rutscher; sie zählen nicht mit.",
  samples_averaged: "Beginn und Ende der Rutscher sind verrundet wie durch Mittelung oder Filterung, die nicht angegeben ist.",
  drive_ripple: "Die Kraft schwankt beim Haften mit einer Frequenz, wie es ein ungleichmäßiger Antrieb bewirkt.",
  model_misfit: "Das Modell gibt die Messung nicht ganz wieder; die Bereiche sind deshalb breiter.",
  option_ignored: "Vorgegebene Parameter und Modelle gelten nicht für einen Sensor am Kontakt.",
  period_drifts: "Die Periode ändert sich im Verlauf mehr, als der Zufall erklärt.",
  level_repeats: "Das Kraftniveau wiederholt sich über einen Weg mehr, als der Zufall erklärt (Gestalt der Probe, Antrieb).",
  cycles_remember: "Aufeinanderfolgende Zyklen hängen mehr voneinander ab, als der Zufall erklärt.",
  mass_differs: "Die angegebene Masse passt nicht zur angepassten.",
  near_sensor_resonance: "Die Rutscher liegen nahe der Resonanz des Kraftsensors, der sie zu groß zeigt.",
  clocked: "Die Rutscher folgen dem Takt des angegebenen Antriebs; er bestimmt Frequenz und Abstand.",
  repeated_values: "Jeder Wert steht mehrfach da (der Schreiber ist schneller als der Wandler); jeder zählt einmal.",
  slips_not_inertial: "Die Rutscher sind viel langsamer als die freie Schwingung des Aufbaus: Eigenfrequenz, Masse und Dämpfung sind unsicher.",
  ring_down_differs: "Die Rutscher und die freie Schwingung des Aufbaus sind nicht dieselbe Bewegung; die Anpassung nutzt nur die Rutscher.",
  sensor_too_slow: "Der Sensor ist für diese Zyklen zu träge; von den Rampen bleibt wenig für die Anpassung.",
  hum_fitted: "Eine Störlinie (Netz, Einstreuung, Antrieb) wurde neben den Zyklen mit angepasst.",
  part_of_cycles_fitted: "Angepasst wurde eine Auswahl der Zyklen; Frequenz und Anzahl nutzen alle.",
  mains_in_step: "Die Zyklen laufen im Takt mit dem Netz (50 oder 60 Hz); darin kann sich Brummen verbergen.",
  frequency_differs_at_one_speed: "Bei etwa gleicher Geschwindigkeit weichen die Frequenzen um das Doppelte ab: Geschwindigkeiten prüfen.",
  frequency_does_not_follow_speed: "Die Frequenz folgt der Geschwindigkeit nicht, wie es Stick-Slip täte: Regelung, Resonanz oder ein Muster.",
  recordings_disagree: "Kein gemeinsamer Satz von Parametern erklärt alle Aufzeichnungen; die Bereiche sind breiter.",
  recording_disagrees: "Eine Aufzeichnung passt nicht zu den anderen.",
  slips_not_resolved: "Aufzeichnungen mit weniger als 1,5 Messwerten je Rutscher wurden ausgelassen.",
  stiffness_goes_with_speed: "Die Steifigkeit ändert sich mit einer Potenz der Antriebsgeschwindigkeit.",
  static_friction_ages: "Die Haftreibung wächst mit der Dauer des Haftens.",
  static_friction_differs: "Die Haftreibung ist in den Aufzeichnungen verschieden (andere Oberfläche?).",
  level_differs: "Das Kraftniveau ist stärker verschieden, als das Reibgesetz erklärt (Nullpunkt, andere Oberfläche?).",
  scatter_unknown: "Je Seite nur eine Aufzeichnung: wie Wiederholungen streuen, ist nicht bekannt.",
  scatter_of_one_side: "Auf einer Seite steht nur eine Aufzeichnung.",
  speeds_differ: "Die Antriebsgeschwindigkeiten unterscheiden sich um mehr als 1 %.",
  loads_differ: "Die Normalkräfte unterscheiden sich um mehr als 1 %.",
  zeros_differ: "Der Nullpunkt des Sensors ist nur für einen Teil der Aufzeichnungen angegeben.",
  motions_differ: "Nicht alle zeigen dieselbe Art von Bewegung.",
  recording_repeated: "Dieselbe Aufzeichnung steht zweimal da: das ist keine Wiederholung.",
};

/** Each warning of a report: its meaning in German before its sentence. */
function translateWarnings(page) {
  for (const code of page.querySelectorAll(".warnings li code")) {
    const meaning = kGermanWarnings[code.textContent];
    if (!meaning) continue;
    const english = page.createElement("span");
    english.lang = "en";
    english.style.color = "var(--soft)";
    while (code.previousSibling) english.prepend(code.previousSibling);
    code.before(meaning, page.createElement("br"), english);
  }
}
