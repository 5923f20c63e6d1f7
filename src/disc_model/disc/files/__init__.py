"""Discs from files: tables, universal files of modal tests and finite elements, and the section of
a drawing."""
