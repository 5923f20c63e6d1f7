"""Methods whose work is done in higher rooms than that of their class, attached here to the classes.

`disc_model` imports this package first, so that a class has its methods from wherever it is
imported. Each method imports the room that does its work when it is called: nothing else waits for
matplotlib, or for what reads files.
"""

from disc_model import display
from disc_model.attachable import DiscFiles, RunPictures
from disc_model.attached import disc_files, drawing, run_pictures

# for results with one picture, such as those of `disc_model.stability`
display.draw = drawing.draw

DiscFiles.from_csv = classmethod(disc_files.from_csv)
DiscFiles.from_uff = classmethod(disc_files.from_uff)
DiscFiles.from_section = classmethod(disc_files.from_section)
DiscFiles.to_csv = disc_files.to_csv  # type: ignore[method-assign]

RunPictures.plot = run_pictures.plot  # type: ignore[method-assign]
RunPictures.plot_phase_portrait = run_pictures.plot_phase_portrait  # type: ignore[method-assign]
RunPictures.plot_spectrum = run_pictures.plot_spectrum  # type: ignore[method-assign]
RunPictures.plot_poincare = run_pictures.plot_poincare  # type: ignore[method-assign]
RunPictures.animate = run_pictures.animate  # type: ignore[method-assign]
