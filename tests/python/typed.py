"""What a type checker must accept."""

import numpy as np

import slipfit as sf

recording: sf.Recording = sf.Recording(np.zeros(3), [1.0, 2.0, 3.0], speed="10 mm/s")
result = sf.fit(recording)
stiffness: sf.Estimate = result.stiffness
frame = result.predict([0.01, 0.02]).to_frame()
several = sf.fit({"a": recording, "b": recording})
member: sf.Fit = several.recordings["a"]
