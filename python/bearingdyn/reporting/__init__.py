"""A report: one HTML page that needs nothing else, of a machine, its inputs and what was computed of it."""

from bearingdyn.reporting.blocks import told
from bearingdyn.reporting.chart import Chart, Curve, json_text
from bearingdyn.reporting.of_machine import drawing_html
from bearingdyn.reporting.report import page_files, report

__all__ = ["Chart", "Curve", "drawing_html", "json_text", "page_files", "report", "told"]
