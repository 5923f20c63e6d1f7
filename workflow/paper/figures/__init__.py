"""The paper's figures, drawn from named cases."""
