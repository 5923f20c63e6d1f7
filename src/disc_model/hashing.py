"""Names of `disc_model.provenance` for modules that still ask for them here."""

from disc_model.provenance import canonical_json as canonical_json
from disc_model.provenance import content_key as content_key
