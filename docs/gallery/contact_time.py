"""Contact time against plate thickness.

A sphere of 72.2 kg hits quasi-static plates at 1 m/s. The thinner the plate, the softer it is and
the longer the contact lasts.
"""

import numpy as np
from matplotlib.figure import Figure

from generated.impact import impact

h = np.geomspace(0.04, 1.0, 60)
result = impact(0.13, 72.2, 1.0, h, 1.0, 0.36e9, 0.43e9)
figure = Figure(figsize=(6.4, 3.8), layout="constrained")
axes = figure.subplots()
axes.semilogx(2 * h, 1e3 * result.contact_time)
axes.set(xlabel="plate thickness [m]", ylabel="contact time [ms]", title="Contact time")
