// The report in the page in German: its headings, names, statuses and buttons by a table, its first sentence by patterns.
// Notes and explanations stay English, as does the report that is saved; warnings: german_warnings.js.
const kGermanReport = new Map(Object.entries({
  "Parameters of the model": "Parameter des Modells", "The recording and the fit": "Aufzeichnung und Anpassung",
  Frequency: "Frequenz", "Overlaid cycles": "Zyklen übereinandergelegt",
  "Damping from peaks and troughs": "Dämpfung aus Spitzen und Tälern", "Stability map": "Stabilitätskarte",
  "Spacing and frequency at other speeds": "Abstand und Frequenz bei anderen Geschwindigkeiten",
  "Predicted abrasion pattern": "Vorhergesagtes Abriebmuster", "Data quality": "Güte der Daten", "All numbers": "Alle Zahlen",
  "Models compared": "Verglichene Modelle", "Warnings": "Warnungen", "Assumed in the fit:": "Bei der Anpassung angenommen:",
  "In brackets: 95 % intervals.": "In Klammern: 95-%-Bereiche.", "The text report, as printed by the command line": "Der Bericht als Text, wie auf der Befehlszeile (englisch)",
  parameter: "Größe", value: "Wert", unit: "Einheit", "95 % interval": "95-%-Bereich", "what the data say": "was die Daten sagen",
  model: "Modell", "residual, rms": "Residuum, rms", why: "Begründung", chosen: "gewählt", "not chosen": "nicht gewählt", "not known": "nicht bekannt",
  frequency: "Frequenz", "pattern spacing V/f": "Musterabstand V/f", stiffness: "Steifigkeit", "damping ratio": "Dämpfungsgrad", "critical speed": "Grenzgeschwindigkeit",
  "tangential stiffness k": "Tangentialsteifigkeit k", "friction drop F": "Reibungsabfall F", "static friction F": "Haftreibung F",
  "kinetic friction F": "Gleitreibung F", "natural frequency ω": "Eigenkreisfrequenz ω", "effective mass m": "wirksame Masse m", "damping ratio ζ": "Dämpfungsgrad ζ",
  "damping coefficient c": "Dämpfungskonstante c",
  identified: "bestimmt", conditional: "bedingt", bounded: "begrenzt", unidentified: "unbestimmt", fixed: "vorgegeben",
  ": the data determine it": ": die Daten bestimmen es", ": the data do not determine it": ": die Daten bestimmen es nicht",
  ": only an interval is known": ": nur der Bereich ist bekannt", ": held at the stated value": ": auf dem vorgegebenen Wert gehalten",
  ": well determined if the assumption in its note holds": ": bestimmt, wenn die Annahme in der Anmerkung zutrifft",
  samples: "Messwerte", "sampling rate": "Abtastrate", duration: "Dauer", "noise, rms": "Rauschen, rms", "clock jitter": "Schwankung des Takts",
  "residual of the fit, rms": "Residuum der Anpassung, rms", "residual over noise (1: only noise is left)": "Residuum durch Rauschen (1: nur Rauschen bleibt)",
  "less than 0.01 % of a step": "weniger als 0,01 % eines Schritts",
  "No gaps, no clipping, no impulses, no rows left out.": "Keine Lücken, nichts abgeschnitten, keine Ausreißer, keine Zeilen ausgelassen.",
  "Zoom in": "Vergrößern", "Zoom out": "Verkleinern", "Previous slip": "Voriger Rutscher", "Next slip": "Nächster Rutscher", "Whole recording": "Ganze Aufzeichnung",
  measured: "gemessen", fit: "Anpassung", slips: "Rutscher", "spectrum of the force": "Spektrum der Kraft", "harmonics found": "gefundene Oberschwingungen",
  "measured cycles": "gemessene Zyklen", "fit of a typical cycle": "Anpassung eines typischen Zyklus", "no damping, slope -1": "ohne Dämpfung, Steigung -1",
  cycles: "Zyklen", "95 % interval": "95-%-Bereich", "95 % intervals": "95-%-Bereiche", "exact limit of stick-slip": "Grenze des Stick-Slip", "this recording": "diese Aufzeichnung",
  predicted: "vorhergesagt", "stick-slip ends, 95 %": "Stick-Slip endet, 95 %", "measured, 95 %": "gemessen, 95 %", "its 95 % band": "sein 95-%-Band",
  time: "Zeit", "time since the slip began": "Zeit seit Beginn des Rutschers", "friction force": "Reibkraft", residual: "Residuum",
  "friction force above kinetic level": "Reibkraft über der Gleitreibung", "rms per bin": "rms je Linie", "driving speed": "Antriebsgeschwindigkeit",
  "pattern spacing": "Musterabstand", "peak above kinetic friction": "Spitze über der Gleitreibung", "trough above kinetic friction": "Tal über der Gleitreibung",
  "path, coarse pattern (stick-slip)": "Weg, grobes Muster (Stick-Slip)", "path, fine pattern (an estimate)": "Weg, feines Muster (Schätzung)",
  "stick-slip parameter λ = ωₙ (Fₛ − Fₖ) / (k V)": "Stick-Slip-Parameter λ = ωₙ (Fₛ − Fₖ) / (k V)",
  "Copy table": "Tabelle kopieren", command: "Befehl", warnings: "Warnungen", status: "Status", speed: "Geschwindigkeit", recording: "Aufzeichnung", quantity: "Größe", difference: "Unterschied", ratio: "Verhältnis",
}));
const kGermanPatterns = [
  [/^Stick-slip at (.*): a pattern of (.*) spacing at (.*)\.$/, "Stick-Slip mit $1: ein Muster mit $2 Abstand bei $3."],
  [/^Stick-slip at (.*): at (.*)\.$/, "Stick-Slip mit $1 bei $2."],
  [/^Stick-slip of undetermined frequency\.$/, "Stick-Slip, aber ohne bestimmbare Frequenz."],
  [/^Steady sliding at (.*): no stick-slip, no pattern\.$/, "Gleichmäßiges Gleiten bei $1: kein Stick-Slip, kein Muster."],
  [/^Oscillatory slip(?: at (.*))?: almost no sticks\.$/, "Schwingendes Rutschen $1: der Körper haftet kaum."],
  [/^The data do not determine whether this is stick-slip\.$/, "Ob dies Stick-Slip ist, lässt sich nicht sagen."],
  [/^(\d+) cycles of straight sticks and quick slips, residual (.*) % of the friction drop$/, "$1 Zyklen aus geradem Haften und schnellem Rutschen, Residuum $2 % des Kraftabfalls"],
  [/^chosen frequency, (.*)$/, "gewählte Frequenz, $1"], [/^fitted damping, slope (.*)$/, "angepasste Dämpfung, Steigung $1"],
];

function germanOf(text) {
  const told = kGermanReport.get(text);
  if (told) return told;
  const [, name, unit] = /^(.*\S)( +\[.*\])$/.exec(text) ?? [];
  if (kGermanReport.has(name)) return kGermanReport.get(name) + unit;
  const match = kGermanPatterns.find(([pattern]) => pattern.test(text));
  return match ? text.replace(match[0], match[1]) : null;
}
function translateReport(page) {
  page.documentElement.lang = "de";
  const walker = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT,
    (node) => (node.parentElement.closest("script, style, pre, code, .file, h1") ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT));
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const german = germanOf(node.data.trim());
    if (german) node.data = node.data.replace(node.data.trim(), () => german);
  }
  translateWarnings(page);
}
