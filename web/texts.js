// Words of the page in German; the English ones stand in page.html and at their use.
const kGerman = {
  language: "Sprache",
  promise: "Passt ein Stick-Slip-Modell an Kraftaufzeichnungen von Gleitversuchen an. Alles wird in dieser Seite gerechnet; keine Datei verlässt diesen Rechner.",
  open: "1. Aufzeichnungen öffnen",
  drop: "Dateien oder einen Ordner hier ablegen: Text, CSV, Excel (.xlsx), MATLAB (.mat), HDF5, TDMS, auch komprimiert (.gz, .zip).",
  choose: "Dateien wählen", "choose-folder": "Ordner wählen", paste: "Tabelle einfügen", example: "Beispiel öffnen",
  pasted: "Spalten mit Zeit und Kraft, wie aus einer Tabelle kopiert:", take: "Diese Zeilen verwenden",
  file: "Datei", speed: "Antriebs\u00adgeschwin\u00addigkeit", side: "Seite", remove: "entfernen",
  together: "Mehrere Dateien", "mode-single": "die gewählte anpassen",
  "mode-each": "jede für sich anpassen (Tabelle)",
  "mode-sweep": "alle gemeinsam anpassen (mehrere Geschwindigkeiten)", "mode-compare": "Seite A mit Seite B vergleichen",
  understood: "2. Inhalt prüfen", assumed: "Annahmen beim Lesen",
  trace: "3. Verlauf prüfen und Abschnitt wählen",
  "trace-guide": "Im Bild ziehen vergrößert, mit Umschalttaste verschiebt; Doppelklick zeigt alles. Die zwei Griffe (oder Pfeiltasten auf ihnen) wählen den Abschnitt der Anpassung.",
  "zoom-in": "Vergrößern", "zoom-out": "Verkleinern", "zoom-all": "Ganze Aufzeichnung",
  "window-shown": "Sichtbaren Abschnitt wählen", "window-all": "Alles wählen",
  "key-force": "Kraft", "key-slips": "Rutscher", "key-slides": "gleitender Teil", "key-gaps": "Lücken", "key-outliers": "Ausreißer",
  run: "4. Anpassen", fit: "Anpassen", stop: "Abbrechen", command: "Dasselbe auf der Befehlszeile:", result: "5. Ergebnis",
  "save-report": "Bericht sichern", "save-json": "JSON sichern", "save-cycles": "Zyklen sichern (CSV)",
  "save-curve": "Kurve sichern (CSV)", "save-zip": "Alles sichern (.zip)", "save-project": "Projekt sichern",
  comma: "CSV mit Dezimalkomma", elsewhere: "Bei anderer Geschwindigkeit",
  footer: "Funktioniert ohne Netz. Fehlermeldungen, Anmerkungen und gesicherte Berichte sind englisch.",
  "time-column": "Zeitspalte", "force-column": "Kraftspalte", "normal-force-column": "Normalkraftspalte",
  "speed-column": "Geschwindigkeitsspalte", "time-unit": "Einheit der Zeit", "force-unit": "Einheit der Kraft", radius: "Radius",
  "normal-force": "Normalkraft", zero: "Nullpunkt der Kraft", "force-view": "Sensor misst", step: "Schritt",
  strokes: "Hübe", "sample-rate": "Abtastrate", mass: "Bewegte Masse", "sensor-average": "Mittelungszeit",
  "speed-uncertainty": "Unsicherheit v", sheet: "Blatt", variable: "Variable", more: "Weitere Angaben", surface: "Verschleißspur: Muster mit den Rutschern vergleichen", "surface-file": "Profil der Oberfläche (Text, X3P, SDF)",
  drift: "Trend des Kraftniveaus", "drift-sensor": "Drift des Sensors", "drift-friction": "Reibung ändert sich",
  automatic: "automatisch", "view-spring": "Federkraft", "view-transmitted": "übertragene Kraft", "view-contact": "Kraft am Kontakt",
  "strokes-none": "nicht teilen", "strokes-both": "beide Richtungen", "strokes-positive": "positive", "strokes-negative": "negative",
  segments: "Abschnitte konstanter Geschwindigkeit", all: "alle", "speed-missing": "Die Antriebsgeschwindigkeit fehlt: bitte angeben.",
  computing: "rechnet", reading: "liest", stopped: "abgebrochen", done: "fertig nach",
  rows: "Zeilen", columns: "Spalten", samples: "Messwerte je Sekunde", slides: "gleitet von", to: "bis", steps: "Schritte", counted: "Rutscher erkannt",
  "window-is": "Abschnitt", impulses: "Ausreißer", gaps: "Lücken", clipped: "abgeschnittene Werte",
  each: "Jede Aufzeichnung für sich", "each-save": "Tabelle sichern (CSV)", refused: "nicht angepasst", status: "Status", warnings: "Warnungen",
  stiffness: "Steifigkeit", damping: "Dämpfungsgrad",
  stick_slip: "Stick-Slip", stick_slip_bistable: "Stick-Slip (bistabil)", steady_sliding: "gleichmäßiges Gleiten",
  oscillatory_slip: "schwingendes Rutschen", undetermined: "unbestimmt",
  period: "Periode", frequency: "Frequenz", spacing: "Abstand der Rutscher", regime: "Art des Gleitens", outside: "keine Rutscher",
  "too-old": "Dieser Browser ist zu alt: es fehlt WebAssembly mit Ausnahmen. Chrome ab 95, Firefox ab 113, Safari ab 16.4.",
  nothing: "Nichts zum Einfügen: erst Spalten in einer Tabelle kopieren.",
};
function say(key, english) {
  return document.documentElement.lang === "de" ? (kGerman[key] ?? english) : english;
}
/** A kind of motion or a regime by its name in documents. */
const kindWords = (name) => say(name, String(name ?? "?").replaceAll("_", " "));
function setLanguage(language) {
  document.documentElement.lang = language;
  for (const element of document.querySelectorAll("[data-t]")) {
    element.dataset.english ??= element.textContent;
    element.textContent = say(element.dataset.t, element.dataset.english);
  }
}
