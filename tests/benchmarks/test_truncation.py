"""What truncating the modes does to what a study asks for."""

import numpy as np
import pytest

from disc_model.benchmarks import figures
from disc_model.benchmarks.truncation import contact_study, truncation_study
from disc_model.figures.drawing import save


@pytest.mark.compiled
def test_study_and_its_figure(tmp_path):
    study = truncation_study((4, 6), (0, 1), ("as_published",), horizon=60.0, growth=False)
    first = study["first_separation"].sel(normalization="as_published", circles=0)
    assert float(first.sel(diameters=4)) == pytest.approx(54.4189, abs=1e-3)
    assert float(first.sel(diameters=6)) == pytest.approx(53.51, abs=0.01)
    assert (study["impact_share"].diff("diameters") < 0).all()
    assert np.isnan(study["growth_rate"]).all()
    save(figures.truncation(study), tmp_path / "truncation.png")
    assert (tmp_path / "truncation.png").stat().st_size > 5000


@pytest.mark.compiled
@pytest.mark.slow  # kernels of one more law of contact
def test_study_of_residual_flexibility_and_its_figure(tmp_path):
    case = {"N=800": {"N": 800.0, "Omega": 30.0, "normalization": "orthonormal"}}
    study = contact_study(((3, 0), (4, 0)), case, horizon=20.0).isel(case=0)
    first, error = study["first_separation"], study["frequency_error"]
    assert float(first.sel(contact="rigid", model="4,0")) == pytest.approx(13.546, abs=1e-3)
    assert float(first.sel(contact="residual", model="4,0")) == pytest.approx(18.399, abs=1e-3)
    assert (error.sel(contact="residual") < error.sel(contact="rigid")).all()
    assert (study["contact_compliance"].sel(contact="rigid") == 0).all()
    assert np.isfinite(study.to_dataarray()).all()
    assert (study["tol_late"] == 1e-10).all()
    # once apart, a compliant contact is met again and again
    assert (study["separations"].sel(contact="residual") > 2 * study["separations"].sel(contact="rigid")).all()
    save(figures.contact_truncation(study.expand_dims("case")), tmp_path / "truncation.png")
    assert (tmp_path / "truncation.png").stat().st_size > 5000
