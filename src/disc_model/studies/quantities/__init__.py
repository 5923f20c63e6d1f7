"""The quantities that studies compute: one function of a case each, see `disc_model.studies.quantity.HOMES`."""
