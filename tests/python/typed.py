"""What a type checker must accept."""

from typing import Dict

import numpy as np

import slipfit as sf

recording: sf.Recording = sf.Recording(np.zeros(3), [1.0, 2.0, 3.0], speed="10 mm/s")
result = sf.fit(recording)
stiffness: sf.Estimate = result.stiffness
frame = result.predict([0.01, 0.02]).to_frame()
several = sf.fit({"a": recording, "b": recording})
member: sf.Fit = several.recordings["a"]
read: sf.Recording = sf.read_recording("run7.csv", speed="10 mm/s", window=(2, 60))
strokes: Dict[str, sf.Recording] = sf.read_recording("run7.csv", speed=0.01, strokes=True)
segments: Dict[str, sf.Recording] = sf.read_recording("run7.csv", segments=True)
saved: sf.Fit = sf.read_fit("run7.json")
draws = saved.sample(100)
