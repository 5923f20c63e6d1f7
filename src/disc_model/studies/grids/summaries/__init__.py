"""Summaries of merged studies over one dimension, for each value of the others: modules named as their quantities."""
