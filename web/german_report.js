// The report in the page in German: its headings, names, statuses and buttons by a table, its first sentence by patterns.
// Notes and explanations stay English, as does the report that is saved; warnings: german_warnings.js.
const kGermanReport = new Map(Object.entries({
  "Parameters of the model": "Parameter des Modells", "The recording and the fit": "Aufzeichnung und Anpassung",
  Frequency: "Frequenz", "Overlaid cycles": "Zyklen übereinandergelegt", "Evolution over the slips": "Entwicklung über die Rutscher", "number of the slip": "Nummer des Rutschers",
  "Damping from peaks and troughs": "Dämpfung aus Spitzen und Tälern", "Stability map": "Stabilitätskarte",
  "Spacing and frequency at other speeds": "Abstand und Frequenz bei anderen Geschwindigkeiten",
  "Predicted abrasion pattern": "Vorhergesagtes Abriebmuster", "Data quality": "Güte der Daten", "All numbers": "Alle Zahlen",
  "Models compared": "Verglichene Modelle", "Warnings": "Warnungen", "Accounted for in the analysis": "Bereits berücksichtigt",
  "In brackets: 95 % intervals.": "In Klammern: 95-%-Bereiche.", "Frequency, cycles, spacing, prediction and tests as tables": "Frequenz, Zyklen, Abstand, Vorhersage und Tests als Tabellen",
  parameter: "Größe", value: "Wert", unit: "Einheit", "95 % interval": "95-%-Bereich", status: "Status",
  model: "Modell", why: "Begründung", chosen: "gewählt", "not chosen": "nicht gewählt", "not known": "nicht bekannt",
  frequency: "Frequenz", "pattern spacing V/f": "Musterabstand V/f", stiffness: "Steifigkeit", "damping ratio": "Dämpfungsgrad", "critical speed": "Grenzgeschwindigkeit",
  "tangential stiffness k": "Tangentialsteifigkeit k", "friction drop F": "Reibungsabfall F", "static friction F": "Haftreibung F",
  "kinetic friction F": "Gleitreibung F", "natural frequency ω": "Eigenkreisfrequenz ω", "effective mass m": "wirksame Masse m", "damping ratio ζ": "Dämpfungsgrad ζ",
  "damping coefficient c": "Dämpfungskonstante c",
  identified: "bestimmt", conditional: "bedingt", bounded: "begrenzt", unidentified: "unbestimmt", fixed: "vorgegeben",
  ": the data determine it": ": die Daten bestimmen es", ": the data do not determine it": ": die Daten bestimmen es nicht",
  ": only an interval is known": ": nur der Bereich ist bekannt", ": fixed at the stated value": ": auf dem vorgegebenen Wert gehalten",
  ": determined if the assumption in its note holds": ": bestimmt, wenn die Annahme in der Anmerkung zutrifft",
  samples: "Messwerte", "sampling rate": "Abtastrate", duration: "Dauer", "noise, rms": "Rauschen, rms", "clock jitter": "Schwankung des Takts",
  Cycles: "Zyklen", "Before and after the sliding": "Vor und nach dem Gleiten", "On the worn surface": "Auf der abgeriebenen Fläche",
  "Predicted by the model at this speed": "Vom Modell bei dieser Geschwindigkeit vorhergesagt", Tests: "Tests", Pattern: "Muster",
  "by FFT": "mit FFT", "by counting slips": "durch Zählen der Rutscher", result: "Ergebnis", period: "Periode", rhythm: "Takt", "slip time": "Rutschzeit",
  "stick time": "Haftzeit", "sticking degree": "Haftgrad", "peak force": "Spitzenkraft", "trough force": "Talkraft", "force drop": "Kraftabfall",
  "slope of the sticks / V": "Steigung des Haftens / V", "trend of the level": "Trend des Niveaus", "impulses along the path": "Impulse entlang des Weges",
  "less than 0.01 % of a step": "weniger als 0,01 % eines Schritts",
  "No gaps, no clipping, no impulses, no rows left out": "Keine Lücken, nichts abgeschnitten, keine Ausreißer, keine Zeilen ausgelassen",
  "Zoom in": "Vergrößern", "Zoom out": "Verkleinern", "Previous slip": "Voriger Rutscher", "Next slip": "Nächster Rutscher", "Whole recording": "Ganze Aufzeichnung",
  measured: "gemessen", fit: "Anpassung", slips: "Rutscher", "spectrum of the force": "Spektrum der Kraft", "harmonics found": "gefundene Oberschwingungen",
  "measured cycles": "gemessene Zyklen", "fit of a typical cycle": "Anpassung eines typischen Zyklus", "no damping, slope -1": "ohne Dämpfung, Steigung -1",
  cycles: "Zyklen", "95 % interval": "95-%-Bereich", "95 % intervals": "95-%-Bereiche", "exact limit of stick-slip": "Grenze des Stick-Slip", "this recording": "diese Aufzeichnung",
  predicted: "vorhergesagt", "stick-slip ends, 95 %": "Stick-Slip endet, 95 %", "measured, 95 %": "gemessen, 95 %", "its 95 % band": "sein 95-%-Band",
  time: "Zeit", "time since the slip began": "Zeit seit Beginn des Rutschers", "friction force": "Reibkraft", residual: "Residuum",
  "friction force above kinetic level": "Reibkraft über der Gleitreibung", "friction force above trough": "Reibkraft über dem Tal", "rms per bin": "rms je Linie", "driving speed": "Antriebsgeschwindigkeit",
  "pattern spacing": "Musterabstand", "peak above kinetic friction": "Spitze über der Gleitreibung", "trough above kinetic friction": "Tal über der Gleitreibung",
  "path, coarse pattern (stick-slip)": "Weg, grobes Muster (Stick-Slip)", "path, fine pattern (an estimate)": "Weg, feines Muster (Schätzung)",
  "stick-slip parameter λ = ωₙ (Fₛ − Fₖ) / (k V)": "Stick-Slip-Parameter λ = ωₙ (Fₛ − Fₖ) / (k V)",
  "The recording": "Die Aufzeichnung", "To repeat this": "Zum Wiederholen", "Charts that are not available": "Diagramme, die fehlen",
  "Coefficient of friction": "Reibungszahl", Distributions: "Verteilungen", Failures: "Fehlschläge", Recordings: "Aufzeichnungen",
  "Parameters of all recordings": "Parameter aller Aufzeichnungen", "Pattern spacing over speed": "Musterabstand über der Geschwindigkeit",
  "Friction over speed": "Reibung über der Geschwindigkeit", "Each recording, predicted without it": "Jede Aufzeichnung, ohne sie vorhergesagt",
  "At one speed: scatter between the recordings": "Bei einer Geschwindigkeit: Streuung zwischen den Aufzeichnungen",
  "Overlaid cycles of the recordings": "Zyklen der Aufzeichnungen übereinandergelegt", "The recordings": "Die Aufzeichnungen",
  "The recordings, continued": "Die Aufzeichnungen, Fortsetzung", "What is compared": "Was verglichen wird", "What cannot be compared": "Was sich nicht vergleichen lässt",
  "Overlaid cycles of A and B": "Zyklen von A und B übereinandergelegt", "The profile": "Das Profil",
  program: "Programm", file: "Datei", "digest of its bytes": "Prüfsumme der Datei", "normal force": "Normalkraft", "not given": "nicht angegeben",
  "force that the sensor measures": "Kraft, die der Sensor misst", "sensor's zero": "Nullpunkt des Sensors", "Assumed while reading:": "Beim Lesen angenommen:",
  weak: "schwach", ": an estimate that should be confirmed": ": eine Schätzung, die der Bestätigung bedarf",
  "velocity dependence α": "Geschwindigkeitsabhängigkeit α", "friction at high speed f0": "Reibung bei hoher Geschwindigkeit f0",
  "velocity-dependent friction f1": "geschwindigkeitsabhängige Reibung f1", "stiffness exponent p, k ~ V^p": "Exponent p der Steifigkeit, k ~ V^p",
  "ageing rate B of static friction": "Alterungsrate B der Haftreibung", "ageing cut-off time t_c": "Anfangszeit t_c der Alterung",
  "sensor averaging time T_b": "Mittelungszeit T_b des Sensors", "slip-weakening distance D_c": "Gleitweg D_c der Schwächung", "drop of the friction coefficient": "Abfall der Reibungszahl",
  "static friction coefficient": "Haftreibungszahl", "kinetic friction coefficient": "Gleitreibungszahl", "force recovery after a slip, A": "Krafterholung nach einem Rutscher, A",
  "recovery length l": "Erholungslänge l", "frequency of the slips": "Frequenz der Rutscher",
  shows: "zeigt", differs: "verschieden", yes: "ja", no: "nein", "not shown": "nicht gezeigt", "stick-slip": "Stick-Slip", "no stick-slip": "kein Stick-Slip",
  "overdamped, ζ ≥ 1": "überdämpft, ζ ≥ 1", sliding: "Gleiten", "measured, enlarged": "gemessen, vergrößert", "slip begins": "Rutscher beginnt", "slip ends": "Rutscher endet",
  "joint fit": "gemeinsame Anpassung", "measured (V/f)": "gemessen (V/f)", "predicted without it": "ohne sie vorhergesagt", "spacing measured, V/f": "Abstand gemessen, V/f",
  "off by": "Abweichung", "k without it": "k ohne sie", "without it": "ohne sie", sawtooth: "Sägezahn", undamped: "ungedämpft", damped: "gedämpft",
  velocity: "mit der Geschwindigkeit", weakening: "schwächend", spring: "Feder", transmitted: "übertragen", contact: "am Kontakt", "kinetic friction by the fit": "Gleitreibung nach der Anpassung", "steady sliding, mean force": "gleichmäßiges Gleiten, mittlere Kraft",
  "on the worn surface": "auf der abgeriebenen Fläche", profile: "Profil", spacing: "Abstand", force: "Kraft", "position along the track": "Ort entlang der Spur", height: "Höhe",
  "path of the drive since the slip began": "Weg des Antriebs seit Beginn des Rutschers",
  "Copy table": "Tabelle kopieren", command: "Befehl", warnings: "Warnungen", status: "Status", speed: "Geschwindigkeit", recording: "Aufzeichnung", quantity: "Größe", difference: "Unterschied", ratio: "Verhältnis",
}));
const kGermanPatterns = [
  [/^Spacing, measured \(V\/f\) at (.*)$/, "Abstand, gemessen (V/f) bei $1"],
  [/^Stick-slip at (.*): a pattern of (.*) spacing at (.*)\.$/, "Stick-Slip mit $1: ein Muster mit $2 Abstand bei $3."],
  [/^Stick-slip at (.*): at (.*)\.$/, "Stick-Slip mit $1 bei $2."],
  [/^Stick-slip of undetermined frequency\.$/, "Stick-Slip, aber ohne bestimmbare Frequenz."],
  [/^Steady sliding at (.*): no stick-slip, no pattern\.$/, "Gleichmäßiges Gleiten bei $1: kein Stick-Slip, kein Muster."],
  [/^Oscillatory slip(?: at (.*))?: almost no sticks\.$/, "Schwingendes Rutschen $1: der Körper haftet kaum."],
  [/^The data do not determine whether this is stick-slip\.$/, "Ob dies Stick-Slip ist, lässt sich nicht sagen."],
  [/^(\d+) cycles of straight sticks and quick slips, residual (.*) % of the friction drop$/, "$1 Zyklen aus geradem Haften und schnellem Rutschen, Residuum $2 % des Kraftabfalls"],
  [/^(\d+) recordings, no joint fit\.$/, "$1 Aufzeichnungen, keine gemeinsame Anpassung."],
  [/^(\d+) recordings, (\d+) fitted together: stick-slip ends at (.*)\.$/, "$1 Aufzeichnungen, $2 gemeinsam angepasst: Stick-Slip endet bei $3."],
  [/^(\d+) recordings, (\d+) fitted together: the end of stick-slip is unknown\.$/, "$1 Aufzeichnungen, $2 gemeinsam angepasst: wo Stick-Slip endet, ist nicht bekannt."],
  [/^(\d+) recordings, (\d+) fitted together\.$/, "$1 Aufzeichnungen, $2 gemeinsam angepasst."],
  [/^A and B differ in (\d+) of (\d+) quantities(.*)\.$/, "A und B unterscheiden sich in $1 von $2 Größen$3."],
  [/^No difference is shown in any of (\d+) quantities\.$/, "In keiner von $1 Größen zeigt sich ein Unterschied."],
  [/^No quantity is known on both sides: nothing can be compared\.$/, "Keine Größe ist auf beiden Seiten bekannt: es gibt nichts zu vergleichen."],
  [/^Ridges every (.*)$/, "Riefen alle $1"], [/^No pattern$/, "Kein Muster"], [/^Pattern not determined$/, "Ob es ein Muster gibt, ist nicht bekannt"], [/^(\d+) ridges$/, "$1 Riefen"],
  [/^chosen frequency, (.*)$/, "gewählte Frequenz, $1"], [/^fitted damping, slope (.*)$/, "angepasste Dämpfung, Steigung $1"],
];

function germanOf(text) {
  const told = kGermanReport.get(text);
  if (told) return told;
  const [, name, unit] = /^(.*\S)( +(?:\[.*\]|\(\S*\)))$/.exec(text) ?? [];
  if (kGermanReport.has(name)) return kGermanReport.get(name) + unit;
  const match = kGermanPatterns.find(([pattern]) => pattern.test(text));
  return match ? text.replace(match[0], match[1]) : null;
}
function translateReport(page) {
  page.documentElement.lang = "de";
  page.documentElement.classList.add("is-translated"); // legends as lists: German words are longer than their places in the charts
  const walker = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT,
    (node) => (node.parentElement.closest("script, style, pre, code, .file, h1") ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT));
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const german = germanOf(node.data.trim());
    if (german) node.data = node.data.replace(node.data.trim(), () => german);
  }
  translateWarnings(page);
}
